#include "app/scoring/expectations.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/scenario/scenario.h"
#include "core/error.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app::expectations_test {
namespace {

const std::filesystem::path kRoot = PATROL_SOURCE_DIR;

io::Metrics make_metrics() {
  return io::Metrics::parse(R"({
    "mission": {"completed": true, "collisions": 2},
    "pose": {"ate_rmse_m": 0.0712345, "drift_percent": null},
    "stations": [{"name": "box", "map_error_m": 0.04}, {"name": "well", "map_error_m": 0.09}]
  })");
}

io::Expectation at_most(double max) {
  io::Expectation expectation;
  expectation.max = max;
  return expectation;
}

io::Expectation at_least(double min) {
  io::Expectation expectation;
  expectation.min = min;
  return expectation;
}

io::Expectation band(double min, double max) { return {.min = min, .max = max}; }

io::Expectation boolean(bool value) { return {.min = value ? 1.0 : 0.0, .max = value ? 1.0 : 0.0, .is_boolean = true}; }

CheckedExpectation check(const std::string& metric, const io::Expectation& expectation) {
  const std::vector<CheckedExpectation> checks = check_expectations({{metric, expectation}}, make_metrics());
  EXPECT_EQ(checks.size(), 1u);
  return checks.at(0);
}

TEST(Expectations, AnUpperBoundIsMetUpToItself) {
  EXPECT_TRUE(check("pose.ate_rmse_m", at_most(0.08)).is_met);
  EXPECT_TRUE(check("pose.ate_rmse_m", at_most(0.0712345)).is_met);
  EXPECT_FALSE(check("pose.ate_rmse_m", at_most(0.0712344)).is_met);
}

TEST(Expectations, ALowerBoundIsMetDownToItself) {
  EXPECT_TRUE(check("mission.collisions", at_least(2.0)).is_met);
  EXPECT_FALSE(check("mission.collisions", at_least(2.001)).is_met);
}

// Better than the band is as wrong as worse: then nobody understands the result.
TEST(Expectations, ABandRefusesBothSides) {
  EXPECT_TRUE(check("pose.ate_rmse_m", band(0.05, 0.10)).is_met);
  EXPECT_FALSE(check("pose.ate_rmse_m", band(0.08, 0.10)).is_met);
  EXPECT_FALSE(check("pose.ate_rmse_m", band(0.05, 0.07)).is_met);
}

TEST(Expectations, ANumberAloneMustBeEqual) {
  EXPECT_TRUE(check("mission.collisions", band(2.0, 2.0)).is_met);
  EXPECT_FALSE(check("mission.collisions", band(0.0, 0.0)).is_met);
}

TEST(Expectations, BooleansMustBeThatValue) {
  EXPECT_TRUE(check("mission.completed", boolean(true)).is_met);
  EXPECT_FALSE(check("mission.completed", boolean(false)).is_met);
}

TEST(Expectations, WhatWasNotMeasuredIsNotMet) {
  for (const char* metric : {"pose.absent_m", "pose.drift_percent", "nothing", "stations.7.map_error_m", "pose"}) {
    const CheckedExpectation missing = check(metric, band(-1e9, 1e9));
    EXPECT_FALSE(missing.is_measured) << metric;
    EXPECT_FALSE(missing.is_met) << metric;
    EXPECT_EQ(missing.got, "not measured") << metric;
  }
}

TEST(Expectations, StationsGoByNameOrPlace) {
  EXPECT_EQ(check("stations.well.map_error_m", at_most(1.0)).got, "0.09");
  EXPECT_EQ(check("stations.0.map_error_m", at_most(1.0)).got, "0.04");
}

TEST(Expectations, SaysWhatIsWantedAndWhatItGot) {
  EXPECT_EQ(check("pose.ate_rmse_m", at_most(0.15)).wanted, "<= 0.15");
  EXPECT_EQ(check("pose.ate_rmse_m", at_least(0.01)).wanted, ">= 0.01");
  EXPECT_EQ(check("pose.ate_rmse_m", band(0.01, 0.15)).wanted, "0.01 ... 0.15");
  EXPECT_EQ(check("mission.collisions", band(0.0, 0.0)).wanted, "= 0");
  EXPECT_EQ(check("mission.completed", boolean(false)).wanted, "false");
  EXPECT_EQ(check("mission.completed", boolean(false)).got, "true");
  EXPECT_EQ(check("pose.ate_rmse_m", at_most(0.15)).got, "0.07123");
}

/// Checks of a bound of the map's error on a map with a coverage.
std::vector<CheckedExpectation> check_map(double coverage, io::Expectations expectations) {
  expectations["map.nearest_mean_m"] = at_most(0.05);
  return check_expectations(expectations, {{"map", {{"nearest_mean_m", 0.01}, {"coverage", coverage}}}});
}

TEST(Expectations, AMapErrorIsMetOnlyByAMapThatCoversHalfOfTheSurfacesOrWhatIsExpected) {
  EXPECT_TRUE(all_met(check_map(0.5, {})));
  EXPECT_FALSE(all_met(check_map(0.49, {})));
  EXPECT_EQ(check_map(0.49, {}).front().metric, "map.coverage");
  EXPECT_EQ(check_map(0.49, {}).front().wanted, ">= 0.5");
  EXPECT_TRUE(all_met(check_map(0.3, {{"map.coverage", at_least(0.25)}}))) << "the scenario's own floor counts";
  EXPECT_FALSE(all_met(check_map(0.7, {{"map.coverage", at_least(0.8)}})));
  EXPECT_EQ(check_map(0.7, {{"map.coverage", at_least(0.8)}}).size(), 2U);
}

TEST(Expectations, OneMissedOfManyIsNotAllMet) {
  EXPECT_TRUE(all_met({}));
  EXPECT_TRUE(all_met(check_expectations({{"mission.completed", boolean(true)}}, make_metrics())));
  EXPECT_FALSE(all_met(check_expectations(
      {{"mission.completed", boolean(true)}, {"mission.collisions", band(0.0, 0.0)}}, make_metrics())));
}

// A stack in another process publishes what its author has written.
TEST(Expectations, AMetricOfATopicThatTheStackDoesNotPublishSaysSo) {
  io::Metrics metrics = make_metrics();
  metrics["mission"]["completed"] = false;
  metrics["published_topics"] = {"/pose", "/plan"};
  const auto got = [&](const std::string& metric) {
    const std::vector<CheckedExpectation> checks = check_expectations({{metric, at_least(0.5)}}, metrics);
    EXPECT_FALSE(checks.front().is_met) << metric;
    return checks.front().got;
  };
  EXPECT_EQ(got("map.coverage"), "not published: /map");
  EXPECT_EQ(got("odometry.ate_rmse_m"), "not published: /odom");
  EXPECT_EQ(got("inspection.leaks_found"), "not published: /events");
  EXPECT_EQ(got("mission.completed"), "not published: /events");
  EXPECT_FALSE(check_expectations({{"mission.completed", boolean(false)}}, metrics).front().is_met);
  EXPECT_EQ(got("localization.lost_s"), "not published: /localization_confidence");
  EXPECT_EQ(got("range_pose.ate_rmse_m"), "not published: /uwb_odometry/pose");
  EXPECT_EQ(got("pose.coverage"), "not measured");  // published, but not enough of it
  metrics["published_topics"] = {"/map", "/odom", "/events", "/plan"};
  EXPECT_EQ(got("pose.coverage"), "not published: /pose");
  EXPECT_EQ(got("mission.completed"), "0");                // measured without poses
  EXPECT_EQ(got("map.coverage"), "not published: /pose");  // the map is scored with an estimate
  EXPECT_EQ(unpublished_topics(metrics), std::vector<std::string>{"/pose"});
}

/// Metrics of a run without a message on any topic: all counts are 0.
io::Metrics metrics_without_messages(bool is_built_in, const score::RunRecord& record = {}) {
  io::Metrics metrics = io::Metrics::parse(R"({
    "mission": {"completed": false, "reported_completed": false, "false_arrivals": 0, "collisions": 0,
                "sensor_faults_noticed": 0},
    "navigation": {"paths": 0, "detours": 0, "recoveries": 0, "clearance": {"min_m": 0.4}},
    "stations": [{"name": "home", "reached": false, "stand_error_m": null}],
    "goals": [{"name": "goal_1", "arrivals": 0, "failed": 0}],
    "inspection": {"leaks": 1, "leaks_found": 0, "false_alarms": 0}
  })");
  add_published_topics(record, is_built_in, metrics);
  return metrics;
}

CheckedExpectation check_zero(const io::Metrics& metrics, const std::string& metric) {
  return check_expectations({{metric, band(0.0, 0.0)}}, metrics).front();
}

TEST(PublishedTopics, CountsOfATopicThatAStackInAnotherProcessDoesNotPublishAreNotMeasured) {
  const io::Metrics metrics = metrics_without_messages(false);
  for (const char* metric :
       {"inspection.false_alarms", "inspection.leaks_found", "navigation.detours", "navigation.recoveries",
        "mission.sensor_faults_noticed", "mission.false_arrivals", "mission.completed", "stations.home.reached",
        "stations.home.stand_error_m", "goals.goal_1.arrivals"}) {
    EXPECT_FALSE(check_zero(metrics, metric).is_met) << metric;
    EXPECT_EQ(check_zero(metrics, metric).got, "not published: /events") << metric;
  }
  EXPECT_EQ(check_zero(metrics, "navigation.paths").got, "not published: /plan");
  EXPECT_TRUE(check_zero(metrics, "mission.collisions").is_met) << "of the ground truth";
  EXPECT_EQ(io::metric_at(metrics, "inspection.leaks"), 1.0) << "of the world";
  EXPECT_EQ(io::metric_at(metrics, "navigation.clearance.min_m"), 0.4);
}

TEST(PublishedTopics, CountsOfTheBuiltInStackAre0BeforeItsFirstEvent) {
  const io::Metrics metrics = metrics_without_messages(true);
  for (const char* metric : {"inspection.false_alarms", "navigation.detours", "navigation.paths",
                             "mission.sensor_faults_noticed", "mission.completed", "stations.home.reached"}) {
    EXPECT_TRUE(check_zero(metrics, metric).is_met) << metric;
  }
  EXPECT_EQ(unpublished_topics(metrics), (std::vector<std::string>{"/odom", "/map", "/pose"}));
}

TEST(PublishedTopics, AMapAndAPathWithoutContentArePublished) {
  score::RunRecord record;
  record.has_empty_map = record.has_empty_path = true;
  record.T_map_body = {{Time{}, {}}};
  io::Metrics metrics = metrics_without_messages(false, record);
  metrics["map"] = {{"nearest_mean_m", nullptr}, {"coverage", 0.0}, {"occupied_cells", 0}};
  EXPECT_EQ(unpublished_topics(metrics), (std::vector<std::string>{"/odom", "/events"}));
  EXPECT_TRUE(check_zero(metrics, "navigation.paths").is_met);
  EXPECT_TRUE(has_empty_map(metrics));
  EXPECT_EQ(check_zero(metrics, "map.iou").got, "empty: /map");
}

TEST(Expectations, MetricsOfAnOlderRunDoNotSayWhatWasPublished) {
  EXPECT_TRUE(unpublished_topics(make_metrics()).empty());
  EXPECT_EQ(check("map.coverage", at_least(0.5)).got, "not measured");
}

TEST(ExpectedMetrics, GoalsRemoveTheExpectationsOfTheMissionButNotThoseOfOverrides) {
  io::Expectations expectations = {{"mission.completed", boolean(true)},
                                   {"mission.distance_m", at_least(10.0)},
                                   {"stations.box.reached", boolean(true)},
                                   {"stations.goal_1.reached", boolean(true)},
                                   {"stations.box.misspelled", at_most(1.0)},
                                   {"inspection.leaks_found", at_least(1.0)},
                                   {"calibration.uwb.anchor_2.delay_m.holds", boolean(true)},
                                   {"calibration.lidar.yaw_rad.holds", boolean(true)},
                                   {"map.coverage", at_least(0.5)}};
  EXPECT_THAT(drop_mission_expectations({"seed=1", "expect.stations.goal_1.reached=true"}, expectations),
              testing::ElementsAre("calibration.uwb.anchor_2.delay_m.holds", "inspection.leaks_found",
                                   "mission.distance_m", "stations.box.reached"));
  std::vector<std::string> kept;
  for (const auto& [metric, expectation] : expectations) kept.push_back(metric);
  EXPECT_THAT(kept, testing::ElementsAre("calibration.lidar.yaw_rad.holds", "map.coverage", "mission.completed",
                                         "stations.box.misspelled", "stations.goal_1.reached"));
}

TEST(ExpectedMetrics, EveryShippedScenarioRunsToGoalsInsteadOfItsMission) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / "worlds")) {
    if (entry.path().extension() != ".yaml" || entry.path().parent_path().filename() != "scenarios") continue;
    Scenario scenario = load_scenario(entry.path());
    scenario.mission.clear();
    scenario.tour.stations = {{.name = "goal_1"}};
    drop_mission_expectations({}, scenario.expect);
    EXPECT_NO_THROW(check_expected_metrics(scenario, {entry.path().string(), {}})) << entry.path();
    EXPECT_TRUE(scenario.expect.contains("mission.completed")) << entry.path();
  }
}

TEST(ExpectedMetrics, AllExpectationsOfTheShippedScenariosAreKnown) {
  int num_checked = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / "worlds")) {
    if (entry.path().extension() != ".yaml" || entry.path().parent_path().filename() != "scenarios") continue;
    const Scenario scenario = load_scenario(entry.path());
    EXPECT_NO_THROW(check_expected_metrics(scenario, {entry.path().string(), {}})) << entry.path();
    num_checked += static_cast<int>(scenario.expect.size());
  }
  EXPECT_GE(num_checked, 100);
}

TEST(ExpectedMetrics, AnUnknownOneIsRefusedWithItsOverride) {
  Scenario scenario;
  scenario.expect = {{"mission.colisions", {}}};
  EXPECT_THAT(
      [&] {
        check_expected_metrics(scenario, {"a.yaml", {"expect.mission.colisions=0"}});
      },
      testing::ThrowsMessage<InputError>(
          testing::StartsWith("--set expect.mission.colisions=0: unknown metric; did you mean mission.collisions?")));
}

std::string complaint_about_expectation(const std::string& metric, const std::string& value) {
  const std::filesystem::path file = kRoot / "worlds/street/scenarios/short.yaml";
  const std::vector<std::string> overrides = {"expect." + metric + "=" + value};
  try {
    check_expected_metrics(load_scenario(file, overrides), {file.string(), overrides});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ExpectedMetrics, TrueIsRefusedForANumber) {
  EXPECT_EQ(complaint_about_expectation("map.coverage", "true"),
            "--set expect.map.coverage=true: must be a number or an interval {min:, max:}, not true");
  EXPECT_EQ(complaint_about_expectation("mission.fell", "false"), "");
}

TEST(ExpectedMetrics, AnUnknownStationOrParameterIsRefusedBeforeTheRun) {
  EXPECT_THAT(
      complaint_about_expectation("stations.valve_wel_0.reached", "true"),
      testing::StartsWith("--set expect.stations.valve_wel_0.reached=true: unknown station valve_wel_0; did you "
                          "mean valve_well_0?: must be one of "));
  EXPECT_THAT(complaint_about_expectation("stations.99.reached", "true"), testing::HasSubstr("unknown station 99"));
  EXPECT_EQ(complaint_about_expectation("stations.0.reached", "true"), "");
  EXPECT_THAT(
      complaint_about_expectation("calibration.lidar.yaw_deg.holds", "true"),
      testing::StartsWith("--set expect.calibration.lidar.yaw_deg.holds=true: unknown parameter lidar.yaw_deg; did you "
                          "mean lidar.yaw_rad?: must be one of "));
  EXPECT_EQ(complaint_about_expectation("calibration.lidar.yaw_rad.holds", "true"), "");
}

}  // namespace
}  // namespace patrol::app::expectations_test
