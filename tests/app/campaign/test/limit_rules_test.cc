#include "app/campaign/test/limit_rules.h"

#include <gtest/gtest.h>

namespace patrol::app::limit_rules_test {
namespace {

std::string limits(const std::string& metric, const std::vector<double>& values) {
  const auto limits = limits_of(rule_of(metric), values);
  return limits ? to_yaml(*limits) : "none";
}

TEST(LimitRules, AnErrorHasTwoEndsAndTheUpperOneIsAtMostTwiceTheHighestValue) {
  EXPECT_EQ(limits("pose.ate_rmse_m", {0.0021, 0.0032, 0.0024}), "{min: 0.0007, max: 0.0064}");
  EXPECT_EQ(limits("pose.ate_rmse_m", {0.0505}), "{min: 0.016, max: 0.1}");
  EXPECT_EQ(limits("some.error_mm", {110.0, 113.0}), "{min: 36, max: 220}");
}

TEST(LimitRules, AnErrorOfZeroHasNoLowerLimit) {
  EXPECT_EQ(limits("some.error_m", {0.0, 0.5}), "{max: 1}");
  EXPECT_EQ(limits("some.error_m", {0.0}), "{max: 0}");
}

TEST(LimitRules, ASignedErrorIsWidenedOnBothSides) {
  EXPECT_EQ(limits("some.bias_m", {-0.1, 0.2}), "{min: -0.2, max: 0.4}");
  EXPECT_EQ(limits("some.bias_m", {-0.3, -0.3}), "{min: -0.6, max: -0.1}");
}

TEST(LimitRules, DistancesFloorsAndCounts) {
  EXPECT_EQ(limits("mission.distance_m", {193.8, 190.9}), "{min: 171, max: 214}");
  EXPECT_EQ(limits("map.coverage", {0.861, 0.85}), "{min: 0.76}");
  EXPECT_EQ(limits("mission.collisions", {0.0, 0.0}), "{max: 0}");
  EXPECT_EQ(limits("inspection.leaks_found", {1.0, 2.0}), "{min: 1}");
  EXPECT_EQ(limits("inspection.leaks_found", {0.0, 2.0}), "none");
}

TEST(LimitRules, ATruthIsTheSameForAllSeeds) {
  EXPECT_EQ(limits("mission.completed", {1.0, 1.0}), "true");
  EXPECT_EQ(limits("mission.completed", {1.0, 0.0}), "none");
}

TEST(LimitRules, AnAsteriskStandsForOneName) {
  EXPECT_TRUE(is_standard("stations.regulator_box_1.map_error_m"));
  EXPECT_FALSE(is_standard("stations.regulator_box_1.heading_error_deg"));
  EXPECT_FALSE(is_standard("stations.map_error_m"));
  EXPECT_FALSE(is_standard("stations.a.b.map_error_m"));
  EXPECT_TRUE(is_standard("goals.goal_1.position_error_m.mean"));
  EXPECT_FALSE(is_standard("goals.goal_1.position_error_m"));
  EXPECT_FALSE(is_standard("mission.completed.x"));
}

TEST(LimitRules, OneEndMayBeNarrowerAndTheOtherWider) {
  const io::Expectation present{.min = 0.01, .max = 0.08}, proposed{.min = 0.005, .max = 0.02};
  EXPECT_TRUE(is_wider(proposed, present));
  EXPECT_EQ(to_yaml(narrower(proposed, present)), "{min: 0.01, max: 0.02}");
  EXPECT_FALSE(is_wider(narrower(proposed, present), present));
}

}  // namespace
}  // namespace patrol::app::limit_rules_test
