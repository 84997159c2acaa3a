#include "app/campaign/test/calibration.h"

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::calibration_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

SeedRun run(std::uint64_t seed, const std::string& metrics, RunStatus end = RunStatus::kDone) {
  return {.seed = seed,
          .verdict = {.end = end, .message = "", .metrics = io::Metrics::parse(metrics), .checks = {}, .events = {}}};
}

SeedRun walk(std::uint64_t seed, double ate_m, double coverage = 0.8) {
  return run(seed, fmt::format(R"({{"mission": {{"completed": true, "collisions": 0}}, "pose": {{"ate_rmse_m": {}}},
                                   "map": {{"coverage": {}}}, "performance": {{"wall_s": 3}}}})",
                               ate_m, coverage));
}

const CalibratedMetric& metric_of(const Calibration& calibration, const std::string& name) {
  return *std::find_if(calibration.metrics.begin(), calibration.metrics.end(),
                       [&](const CalibratedMetric& metric) { return metric.metric == name; });
}

std::string proposal(const Calibration& calibration, const std::string& name) {
  return expect_section(calibration, true).substr(expect_section(calibration, true).find(name));
}

TEST(Calibration, ProposesStandardMetricsAndThoseExpected) {
  const io::Expectations present = {{"performance.wall_s", {.max = 10.0}}};
  const Calibration calibration = calibrate("walk", present, {walk(1, 0.01), walk(2, 0.02)});
  std::vector<std::string> names;
  for (const CalibratedMetric& metric : calibration.metrics) names.push_back(metric.metric);
  EXPECT_THAT(names, ElementsAre("mission.completed", "mission.collisions", "pose.ate_rmse_m", "map.coverage",
                                 "performance.wall_s"));
  EXPECT_THAT(proposal(calibration, "pose.ate"),
              HasSubstr("pose.ate_rmse_m: {min: 0.0033, max: 0.04}  # measured 0.01 to 0.02\n"));
  EXPECT_THAT(proposal(calibration, "mission.completed"), HasSubstr("mission.completed: true\n"));
}

TEST(Calibration, NoLimitIsWidenedUnlessThatIsAllowed) {
  const io::Expectations present = {{"pose.ate_rmse_m", {.min = 0.005, .max = 0.015}}};
  const Calibration calibration = calibrate("walk", present, {walk(1, 0.01), walk(2, 0.02)});
  const CalibratedMetric& ate = metric_of(calibration, "pose.ate_rmse_m");
  EXPECT_TRUE(ate.is_missed());
  EXPECT_NEAR(ate.slack().value(), 0.75, 1e-12);
  EXPECT_THAT(calibration_text(calibration), HasSubstr("MISSED"));
  EXPECT_EQ(expectations_of(calibration, false).at("pose.ate_rmse_m").max, 0.015);
  EXPECT_EQ(expectations_of(calibration, false).at("pose.ate_rmse_m").min, 0.005);
  EXPECT_EQ(expectations_of(calibration, true).at("pose.ate_rmse_m").max, 0.04);
}

TEST(Calibration, AnExpectationThatEveryRunMissesByFarStays) {
  const io::Expectations present = {{"pose.ate_rmse_m", {.max = 0.001}}};
  const Calibration calibration = calibrate("walk", present, {walk(1, 0.01), walk(2, 0.02)});
  const io::Expectation kept = expectations_of(calibration, false).at("pose.ate_rmse_m");
  EXPECT_EQ(kept.max, 0.001);
  EXPECT_LT(kept.min, kept.max);
}

TEST(Calibration, RunsThatDidNotCompleteAreNoValuesButNamed) {
  const SeedRun fallen = run(2, R"({"mission": {"completed": false}, "pose": {"ate_rmse_m": 9.0}})", RunStatus::kFall);
  const SeedRun stuck =
      run(3, R"({"mission": {"completed": false}, "pose": {"ate_rmse_m": 9.0}})", RunStatus::kExpectationMissed);
  const Calibration calibration = calibrate("walk", {}, {walk(1, 0.01), fallen, stuck});
  EXPECT_THAT(calibration.failures, ElementsAre("seed 2: fall", "seed 3: mission not completed"));
  EXPECT_THAT(metric_of(calibration, "pose.ate_rmse_m").values, ElementsAre(0.01));
}

TEST(Calibration, AMetricThatASeedDoesNotMeasureKeepsItsExpectation) {
  const io::Expectations present = {{"map.coverage", {.min = 0.5}}, {"pose.elegance", {.max = 1.0}}};
  const SeedRun without = run(2, R"({"mission": {"completed": true}, "pose": {"ate_rmse_m": 0.01}})");
  const Calibration calibration = calibrate("walk", present, {walk(1, 0.01), without});
  EXPECT_EQ(metric_of(calibration, "map.coverage").note, "measured with 1 of 2 seeds");
  EXPECT_EQ(metric_of(calibration, "pose.elegance").note, "measured with 0 of 2 seeds");
  EXPECT_EQ(expectations_of(calibration, true).at("map.coverage").min, 0.5);
  EXPECT_THAT(expect_section(calibration, true), Not(HasSubstr("collisions")));
}

TEST(Calibration, AnExactNumberStays) {
  const io::Expectations present = {{"mission.collisions", {.min = 0.0, .max = 0.0}}};
  const Calibration calibration = calibrate("walk", present, {walk(1, 0.01), walk(2, 0.01)});
  EXPECT_THAT(expect_section(calibration, true), HasSubstr("mission.collisions: 0  #"));
}

TEST(Calibration, TheTableHasOneRowForEachMetric) {
  const Calibration calibration = calibrate("walk", {}, {walk(1, 0.01)});
  const io::Table table = calibration_table({calibration});
  EXPECT_EQ(table.rows.size(), calibration.metrics.size());
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size());
}

}  // namespace
}  // namespace patrol::app::calibration_test
