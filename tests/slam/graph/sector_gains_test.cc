#include "slam/graph/sector_gains.h"

#include <limits>

#include <gtest/gtest.h>

namespace patrol::slam::sector_gains_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

MatchPoint point_at(double x, double y) {
  MatchPoint point{};
  point.p_body = {x, y};
  return point;
}

TEST(SectorGains, TenPointsAheadHaveOneVoteAgainstTwoSectorsOfOnePoint) {
  std::vector<MatchPoint> points(10, point_at(5.0, 0.5));
  std::vector<double> a(10, 0.0), b(10, -3.0);  // in favor of a
  for (const MatchPoint& other : {point_at(0.5, 5.0), point_at(-5.0, 0.5)}) {
    points.push_back(other);
    a.push_back(-3.0);
    b.push_back(0.0);
  }
  const SectorGains gains(points, a, b, -1.0);
  EXPECT_DOUBLE_EQ(gains.total(), 24.0);
  EXPECT_EQ(gains.votes(), -1);
  EXPECT_EQ(gains.vote(SectorGains::sector_of(points[0])), 1);
  EXPECT_EQ(gains.vote(SectorGains::sector_of(points[10])), -1);
}

TEST(SectorGains, APointInAnUnknownCellHasTheGivenLogLikelihoodAndADifferenceOf2IsNoVote) {
  const SectorGains gains({point_at(5.0, 0.5)}, {kUnknown}, {-3.0}, -1.0);
  EXPECT_DOUBLE_EQ(gains.total(), 2.0);
  EXPECT_EQ(gains.votes(), 0);
}

}  // namespace
}  // namespace patrol::slam::sector_gains_test
