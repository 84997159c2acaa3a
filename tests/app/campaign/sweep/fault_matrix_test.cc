#include "app/campaign/sweep/fault_matrix.h"

#include <algorithm>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/commands/commands.h"

namespace patrol::app::fault_matrix_test {
namespace {

using ::testing::ElementsAre;

TEST(FaultMatrix, AFaultBecomesTheSettingThatDeclaresIt) {
  EXPECT_EQ(fault_override({.sensor = "imu", .kind = "drift", .start_s = 12.0, .duration_s = 8.0, .magnitude = 0.005}),
            "faults=[{sensor: imu, kind: drift, start_s: 12, duration_s: 8, magnitude: 0.005}]");
}

TEST(FaultMatrix, AVariantsNameIsReadBackAsSensorAndKind) {
  const FaultVariant fault = parse_variant_name(variant_name(
      {.sensor = "joint_encoders", .kind = "clock_offset", .start_s = 12.0, .duration_s = 8.0, .magnitude = 0.2}));
  EXPECT_EQ(fault.sensor, "joint_encoders");
  EXPECT_EQ(fault.kind, "clock_offset");
  EXPECT_EQ(parse_variant_name("no fault").kind, "");
}

TEST(SurvivalOverrides, BoundErrorCoverageAndOnAGivenMapLostTime) {
  const SurvivalBounds bounds{.max_error_m = 0.3, .min_map_coverage = 0.5, .max_lost_s = 10.0};
  Scenario scenario;
  EXPECT_THAT(survival_overrides(scenario, bounds),
              ElementsAre("expect.pose.ate_max_m={max: 0.3}", "expect.map.coverage={min: 0.5}"));
  scenario.map = "map/map.yaml";
  scenario.expect["map.coverage"].min = 0.9;
  EXPECT_THAT(survival_overrides(scenario, bounds),
              ElementsAre("expect.pose.ate_max_m={max: 0.3}", "expect.localization.lost_s={max: 10}"));
}

/// Switches every sensor on.
void enable_sensors(sim::SensorSuiteSettings& settings) {
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if constexpr (HasSensorSettings<Message>) {
      auto& own = settings.*SensorTraits<Message>::kSettings;
      if constexpr (requires { own.enabled; }) own.enabled = true;
    }
  });
}

TEST(FaultMatrix, OnARobotWithEverythingItHasEverySensorOfTheRegistryThatGivesNoReasonAgainst) {
  Scenario scenario;
  enable_sensors(scenario.sensors);
  ScenarioFiles files;
  files.robot.legs.resize(4);
  files.robot.tracks.emplace();
  files.goals.resize(1);
  files.goals.front().type = GoalType::kScan;
  files.recorded.resize(1);
  std::set<std::string> in_matrix;
  for (const sim::FaultSettings& fault : fault_matrix(scenario, files, 12.0, 8.0)) in_matrix.insert(fault.sensor);
  for (const SensorInfo& info : kSensorInfos)
    EXPECT_EQ(in_matrix.contains(info.name), *info.fault_matrix_exclusion_reason == '\0') << info.name;
}

TEST(FaultMatrix, WithoutStationsAndTeleoperationScannerAndTeleopAreNotInIt) {
  Scenario scenario;
  enable_sensors(scenario.sensors);
  for (const sim::FaultSettings& fault : fault_matrix(scenario, {}, 12.0, 8.0)) {
    EXPECT_NE(fault.sensor, "scanner");
    EXPECT_NE(fault.sensor, "teleop");
    EXPECT_NE(fault.sensor, "hall") << "the robot has no tracks";
  }
}

TEST(ListCommand, ListsEverySensorOfTheRegistryWithItsTopic) {
  ::testing::internal::CaptureStdout();
  list_command({});
  const std::string listed = ::testing::internal::GetCapturedStdout();
  for (const SensorInfo& info : kSensorInfos) {
    EXPECT_NE(listed.find(std::string("  ") + info.name + " "), std::string::npos) << info.name;
    EXPECT_NE(listed.find(info.topic), std::string::npos) << info.topic;
  }
}

}  // namespace
}  // namespace patrol::app::fault_matrix_test
