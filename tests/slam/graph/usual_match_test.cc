#include "slam/graph/usual_match.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace patrol::slam::usual_match_test {
namespace {

/// A match of 100 points, `num_matched` of them on surfaces with a loss of 0.2, the others in unknown cells.
struct Match {
  MatchResult result{};
  std::vector<double> log_likelihoods;

  explicit Match(int num_matched, double loss = 0.2) {
    result.num_matched = num_matched;
    result.inlier_ratio = 1.0;
    for (int i = 0; i < 100; ++i)
      log_likelihoods.push_back(i < num_matched ? -loss : std::numeric_limits<double>::quiet_NaN());
  }
};

UsualMatch after_200_matches_of_80_points() {
  UsualMatch usual;
  for (int k = 0; k < 200; ++k) usual.update(Match(80).result, Match(80).log_likelihoods);
  return usual;
}

TEST(UsualMatch, With70Of100PointsInsteadOf80IsUsualAndWith60IsNot) {
  const UsualMatch usual = after_200_matches_of_80_points();
  EXPECT_TRUE(usual.has_usual_points(Match(71).result, Match(71).log_likelihoods));
  EXPECT_FALSE(usual.has_usual_points(Match(69).result, Match(69).log_likelihoods));
}

TEST(UsualMatch, OfAnInlierRatioBelow90PercentIsNotUsual) {
  Match match(80);
  match.result.inlier_ratio = 0.89;
  EXPECT_FALSE(after_200_matches_of_80_points().has_usual_points(match.result, match.log_likelihoods));
}

TEST(UsualMatch, ALossOf1_5TimesTheUsualOneIsTheLargest) {
  const UsualMatch usual = after_200_matches_of_80_points();
  EXPECT_TRUE(usual.has_usual_loss(Match(80, 0.299).log_likelihoods));
  EXPECT_FALSE(usual.has_usual_loss(Match(80, 0.301).log_likelihoods));
}

TEST(UsualMatch, APointInAnUnknownCellCostsTheOddsOfAMatchedPoint) {
  EXPECT_NEAR(after_200_matches_of_80_points().unknown_log_likelihood(), std::log(0.2 / 0.8), 1e-3);
  EXPECT_EQ(UsualMatch().unknown_log_likelihood(), 0.0);
}

}  // namespace
}  // namespace patrol::slam::usual_match_test
