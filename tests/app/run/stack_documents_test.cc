#include "app/run/stack_documents.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "io/yaml/settings_yaml.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::stack_documents_test {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

std::vector<std::string> keys_of(const YAML::Node& map) {
  std::vector<std::string> keys;
  for (const auto& entry : map) keys.push_back(entry.first.as<std::string>());
  return keys;
}

Scenario street() {
  Scenario scenario =
      load_scenario("", {"world=street", "robot=quadruped", "time_limit_s=2", "mission=routes/short.json",
                         "stack.slam.method=rbpf", "sensors.imu.gyro_noise_density_radps_per_sqrt_hz=0.5"});
  scenario.leaks = {{.at = "regulator_box_2"}};
  return scenario;
}

TEST(KnownSettings, HaveTheKeysThatARobotMayKnow) {
  const YAML::Node document = YAML::Load(known_settings(street()));
  EXPECT_THAT(keys_of(document),
              ElementsAre("version", "world", "robot", "seed", "mission", "tour", "map", "goals", "references",
                          "teleop", "mounts", "sensors", "wheel_drive", "stack", "log"));
  EXPECT_THAT(keys_of(document["teleop"]), UnorderedElementsAre("route", "recorded"));
  EXPECT_THAT(keys_of(document["log"]), ElementsAre("map_period_s"));
  for (const auto& sensor : document["sensors"]) EXPECT_THAT(keys_of(sensor.second), ElementsAre("enabled"));
  EXPECT_GT(document["sensors"].size(), 5U);
}

TEST(KnownSettings, AreThoseOfTheRun) {
  const Scenario scenario = street();
  const test::TemporaryFolder folder;
  io::save_text(folder / "documents.yaml", known_settings(scenario));
  const Scenario read = load_scenario(folder / "documents.yaml");
  EXPECT_EQ(io::to_yaml(read.stack), io::to_yaml(scenario.stack));
  EXPECT_EQ(read.stack.slam.method, "rbpf");
  EXPECT_EQ(read.mission, "routes/short.json");
  EXPECT_EQ(read.sensors.lidar.enabled, scenario.sensors.lidar.enabled);
  EXPECT_EQ(read.sensors.lidar3d.enabled, scenario.sensors.lidar3d.enabled);
  EXPECT_EQ(read.sensors.gnss.enabled, scenario.sensors.gnss.enabled);
}

}  // namespace
}  // namespace patrol::app::stack_documents_test
