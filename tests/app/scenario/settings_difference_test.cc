#include "app/scenario/settings_difference.h"

#include <gtest/gtest.h>

namespace patrol::app {

bool operator==(const SettingDifference& a, const SettingDifference& b) {
  return a.path == b.path && a.standard == b.standard && a.value == b.value;
}
void PrintTo(const SettingDifference& difference, std::ostream* out) {
  *out << difference.path << ": " << difference.standard << " -> " << difference.value;
}

namespace {

using Differences = std::vector<SettingDifference>;

const std::filesystem::path kSource = PATROL_SOURCE_DIR;

TEST(SettingsDifferences, AreNoneBetweenTheSame) { EXPECT_TRUE(settings_differences(Scenario{}, Scenario{}).empty()); }

TEST(SettingsDifferences, NamePathDefaultAndValue) {
  Scenario scenario;
  scenario.seed = 7;
  scenario.stack.slam.rbpf.filter.particles += 5;
  scenario.sensors.imu.enabled = false;
  scenario.map = "map/map.yaml";
  const std::string particles = std::to_string(Scenario{}.stack.slam.rbpf.filter.particles);
  EXPECT_EQ(settings_differences(Scenario{}, scenario),
            (Differences{
                {"seed", "1", "7"},
                {"map", "–", "map/map.yaml"},
                {"sensors.imu.enabled", "true", "false"},
                {"stack.slam.rbpf.particles", particles, std::to_string(scenario.stack.slam.rbpf.filter.particles)}}));
}

TEST(SettingsDifferences, AnotherPresetIsOneDifferenceAndItsOverridesAreMore) {
  Scenario scenario;
  scenario.sensors.lidar = LidarSettings::of_preset("utm30lx");
  EXPECT_EQ(settings_differences(Scenario{}, scenario),
            (Differences{{"sensors.lidar.preset", "rplidar_s2", "utm30lx"}}));
  scenario.sensors.lidar.range_noise_std_m = 0.5;
  const Differences differences = settings_differences(Scenario{}, scenario);
  ASSERT_EQ(differences.size(), 2u);
  EXPECT_EQ(differences[1].path, "sensors.lidar.range_noise_std_m");
  EXPECT_EQ(differences[1].value, "0.5");
}

TEST(SettingsDifferences, AnEntryOfAListIsOneLineWithoutItsDefaults) {
  Scenario scenario;
  scenario.actors = {{.name = "car_1", .path = {{.x_m = 1.5}}}};
  const Differences differences = settings_differences(Scenario{}, scenario);
  ASSERT_EQ(differences.size(), 1u);
  EXPECT_EQ(differences[0].path, "actors.0");
  EXPECT_EQ(differences[0].value, "{name: car_1, path: [{x_m: 1.5}]}");
}

TEST(SettingsDifferences, ExpectationsAreNotSettings) {
  Scenario scenario;
  scenario.expect["pose.ate_rmse_m"].max = 1.0;
  EXPECT_TRUE(settings_differences(Scenario{}, scenario).empty());
}

TEST(SettingsDifferences, ARobotsOwnFileIsItsStandard) {
  const std::filesystem::path docking = kSource / "worlds/tunnel/scenarios/docking.yaml";
  const Differences differences = settings_differences(default_scenario("tracked", kSource), load_scenario(docking));
  for (const SettingDifference& difference : differences)
    EXPECT_FALSE(difference.path.starts_with("sensors.")) << difference.path;
  EXPECT_NE(std::find(differences.begin(), differences.end(), SettingDifference{"world", "–", "tunnel"}),
            differences.end());
}

}  // namespace
}  // namespace patrol::app
