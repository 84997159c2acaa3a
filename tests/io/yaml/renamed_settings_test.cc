#include "io/yaml/renamed_settings.h"

#include <gtest/gtest.h>

namespace patrol::io::renamed_settings_test {
namespace {

TEST(RenamedSettings, SectionsAndKeysBelowThemAreRenamedTogether) {
  EXPECT_EQ(renamed_setting("stack.plan"), "stack.navigation");
  EXPECT_EQ(renamed_setting("stack.plan.costmap"), "stack.navigation.costmap");
}

TEST(RenamedSettings, KeysOfListEntriesAreRenamed) {
  EXPECT_EQ(renamed_setting("props.3"), "static_obstacles.3");
  EXPECT_EQ(renamed_setting("props.3.turn_deg"), "static_obstacles.3.yaw_deg");
}

TEST(RenamedSettings, KeysOfSeveralSensorsAreRenamedInEach) {
  EXPECT_EQ(renamed_setting("sensors.lidar3d.range_noise_m"), "sensors.lidar3d.range_noise_std_m");
  EXPECT_EQ(renamed_setting("sensors.uwb.range_noise_m"), "sensors.uwb.range_noise_std_m");
  EXPECT_EQ(renamed_setting("remote.driver.meets_robot"), "teleop.operator.wait_for_robot");
}

TEST(RenamedSettings, KeysThatKeepTheirNameAreReturnedUnchanged) {
  EXPECT_EQ(renamed_setting("stack.navigation.costmap"), "stack.navigation.costmap");
  EXPECT_EQ(renamed_setting("planner"), "planner");
  EXPECT_EQ(renamed_setting(""), "");
}

}  // namespace
}  // namespace patrol::io::renamed_settings_test
