#include "importer/robot/scan_band.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"

namespace patrol::importer::scan_band_test {
namespace {

using ::testing::HasSubstr, ::testing::Not;

TEST(ScanBand, ALidarFromWhichALevelBeamCountsFor10MetersKeepsTheDefaults) {
  EXPECT_FALSE(scan_band_of(0.231, 0.1));
  ASSERT_TRUE(scan_band_of(0.229, 0.1));
  EXPECT_NEAR(scan_band_of(0.229, 0.1)->min_height_m, 0.09, 1e-9);
}

TEST(ScanBand, TheMinimumHeightIs0_4OfThatOfTheLidarAndTheFilterCoversTheRobot) {
  const ScanBand band = scan_band_of(0.07, 0.06).value();
  EXPECT_NEAR(band.min_height_m, 0.02, 1e-9);
  EXPECT_NEAR(band.self_filter_radius_m, 0.11, 1e-9);
  EXPECT_NEAR(scan_band_of(0.01, 0.06)->min_height_m, 0.01, 1e-9);
  EXPECT_EQ(scan_band_of(0.07, 0.5)->self_filter_radius_m, kDefaultSelfFilterRadius_m);
}

/// Robot of 12 cm on wheels of 3.2 cm; the ground is at z = -0.03 in base_link.
std::string small_robot(double lidar_z_m) {
  return robot(link("base_link", inertial(0.4, "0 0 0", 0.0005) + shape("collision", box(0.1, 0.08, 0.04))) +
               wheel("left", "base_link", "0.01 0.046 -0.014", 0.016, 0.008) +
               wheel("right", "base_link", "0.01 -0.046 -0.014", 0.016, 0.008) +
               joint("bj", "fixed", "base_link", "ball", "-0.04 0 -0.022") +
               link("ball", shape("collision", sphere(0.008))) +
               joint("lj", "fixed", "base_link", "laser", fmt::format("0 0 {}", lidar_z_m)) + link("laser"));
}

TEST(ScanBand, TheImportWritesTheSettingsOfALowLidarWithARowAndLeavesThoseOfAHighOne) {
  Import low(small_robot(0.04));
  low.options.frames["lidar"] = "laser";
  low.load();
  EXPECT_THAT(low.robot.settings, HasSubstr("\nstack:\n  odometry_source: wheeled\n"));
  EXPECT_THAT(low.robot.settings,
              HasSubstr("\n  scan_leveling: {min_height_m: 0.02, self_filter_radius_m: 0.12}\n  navigation:\n"));
  EXPECT_THAT(low.assumptions(), HasSubstr("| lidar | is 0.07 m above the ground: its hits are obstacles above 0.02 m "
                                           "(default 0.15 m)"));
  Import high(small_robot(0.21));
  high.options.frames["lidar"] = "laser";
  high.load();
  EXPECT_THAT(high.robot.settings, Not(HasSubstr("scan_leveling")));
  EXPECT_THAT(high.assumptions(), Not(HasSubstr("above the ground: its hits")));
}

TEST(ScanBand, WithoutALidarThereIsNoRow) {
  Import none(small_robot(0.04));
  none.load();
  EXPECT_THAT(none.robot.settings, Not(HasSubstr("scan_leveling")));
}

}  // namespace
}  // namespace patrol::importer::scan_band_test
