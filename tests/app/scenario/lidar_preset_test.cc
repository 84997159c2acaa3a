#include "app/scenario/lidar_preset.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/scenario/scenario.h"
#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::lidar_preset_test {
namespace {

using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::filesystem::path kShort = std::filesystem::path(PATROL_SOURCE_DIR) / "worlds/street/scenarios/short.yaml";

constexpr const char* kFitted =
    "lidar: {preset: tim571, range_noise_std_m: 0.031, beams: 360, fov_deg: 180.0}\n"
    "as_built: {noise_ratio: 1.0, range_offset_m: 0.0, measured_range_offset_m: -0.025}\n";

class LidarPresetFile : public ::testing::Test {
 protected:
  std::string write(const char* name, const std::string& text) {
    test::write_bytes(folder / name, text);
    return (folder / name).string();
  }
  TemporaryFolder folder;
};

TEST_F(LidarPresetFile, SetsSensorAndTolerancesOverItsBaseAndTheRunIsDescribedWithoutTheFile) {
  const Scenario scenario = load_scenario(kShort, {"sensors.lidar.preset=" + write("fitted.yaml", kFitted)});
  EXPECT_EQ(scenario.sensors.lidar.preset, "tim571");
  EXPECT_EQ(scenario.sensors.lidar.range_noise_std_m, 0.031);
  EXPECT_EQ(scenario.sensors.lidar.beams, 360);
  EXPECT_EQ(scenario.sensors.lidar.rate_hz, 15.0);      // of the base
  EXPECT_EQ(scenario.sensors.lidar.range_max_m, 25.0);  // of the base
  EXPECT_TRUE(scenario.sensors.lidar.enabled);
  EXPECT_EQ(scenario.as_built.lidar.measured_range_offset_m, -0.025);
  EXPECT_EQ(scenario.as_built.lidar.range_offset_m, 0.0);
  EXPECT_EQ(scenario.as_built.lidar.noise_ratio, 1.0);
  save_scenario(folder / "a.yaml", scenario, "");
  std::filesystem::remove(folder / "fitted.yaml");
  const Scenario again = load_scenario(folder / "a.yaml");
  save_scenario(folder / "b.yaml", again, "");
  EXPECT_EQ(test::read_bytes(folder / "a.yaml"), test::read_bytes(folder / "b.yaml"));
}

TEST_F(LidarPresetFile, KeysOfTheScenarioWin) {
  const Scenario scenario =
      load_scenario(kShort, {"sensors.lidar.preset=" + write("fitted.yaml", kFitted), "sensors.lidar.beams=90",
                             "as_built.lidar.measured_range_offset_m=0.01"});
  EXPECT_EQ(scenario.sensors.lidar.beams, 90);
  EXPECT_EQ(scenario.sensors.lidar.range_noise_std_m, 0.031);
  EXPECT_EQ(scenario.as_built.lidar.measured_range_offset_m, 0.01);
}

TEST_F(LidarPresetFile, IsFoundByItsNameBelowModelsLidarsAndForAMount) {
  for (const char* name : {"worlds", "models/lidars"}) std::filesystem::create_directories(folder / name);
  write("models/lidars/office.yaml", kFitted);
  write("worlds/my.yaml", "robot: none\nsensors: {lidar: {preset: office}}\n");
  EXPECT_EQ(load_scenario(folder / "worlds/my.yaml").sensors.lidar.range_noise_std_m, 0.031);
  write("models/lidars/rear.yaml", "lidar: {preset: tim571, range_noise_std_m: 0.031}\n");
  write("worlds/rear.yaml", "robot: none\nmounts: [{frame: lidar_rear, x_m: -0.3, preset: rear}]\n");
  const Scenario rear = load_scenario(folder / "worlds/rear.yaml");
  EXPECT_EQ(rear.sensors.lidar_rear.range_noise_std_m, 0.031);
  EXPECT_TRUE(rear.sensors.lidar_rear.enabled);
  EXPECT_EQ(rear.mounts.at(0).preset, "tim571");
  EXPECT_EQ(rear.as_built.lidar.measured_range_offset_m, 0.0);  // the tolerances are those of the front lidar
}

TEST_F(LidarPresetFile, WithTolerancesIsRefusedForLidarsOtherThanThatOfTheFrameLidar) {
  const std::string preset = write("fitted.yaml", kFitted);
  const std::string says = " = " + preset + ": " + preset +
                           ":2: as_built: tolerances are those of the frame lidar: must be absent for lidar_rear";
  const std::string mounts =
      write("mounts.yaml", "robot: none\nmounts:\n  - {frame: lidar_rear, preset: " + preset + "}\n");
  EXPECT_THAT([&] { load_scenario(mounts); },
              ThrowsMessage<InputError>(HasSubstr(mounts + ":3: mounts.0.preset" + says)));
  EXPECT_THAT([&] { load_scenario(kShort, {"sensors.lidar_rear.preset=" + preset}); },
              ThrowsMessage<InputError>(HasSubstr("sensors.lidar_rear.preset" + says)));
}

TEST_F(LidarPresetFile, AnInvalidOneIsRefusedWithItsLineAndKey) {
  const auto load = [&](const std::string& text) {
    const std::string file = write("bad.yaml", text);
    return [file] { load_scenario(kShort, {"sensors.lidar.preset=" + file}); };
  };
  EXPECT_THAT(
      load("lidar:\n  range_noise: 0.1\n"),
      ThrowsMessage<InputError>(AllOf(HasSubstr("bad.yaml:2: lidar.range_noise"), HasSubstr("range_noise_std_m"))));
  EXPECT_THAT(load("lidar: {beams: -4}\n"), ThrowsMessage<InputError>(HasSubstr("bad.yaml:1: lidar.beams")));
  EXPECT_THAT(load("as_built: {noise_ratio: 7}\n"),
              ThrowsMessage<InputError>(HasSubstr("bad.yaml:1: as_built.noise_ratio")));
  EXPECT_THAT([&] { load_scenario(kShort, {"sensors.lidar.preset=absent.yaml"}); },
              ThrowsMessage<InputError>(HasSubstr("sensors.lidar.preset = absent.yaml: file not found")));
  EXPECT_THAT([&] { load_scenario(kShort, {"sensors.lidar.preset=sick"}); },
              ThrowsMessage<InputError>(HasSubstr("must be one of rplidar_s2")));
  EXPECT_THAT([&] { find_lidar_preset("sick", PATROL_SOURCE_DIR, "--lidar"); },
              ThrowsMessage<InputError>(
                  HasSubstr("--lidar = sick: must be one of rplidar_s2, utm30lx, tim571, vlp16, a file")));
}

}  // namespace
}  // namespace patrol::app::lidar_preset_test
