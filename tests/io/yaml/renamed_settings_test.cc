#include "io/yaml/renamed_settings.h"

#include <gtest/gtest.h>

namespace patrol::io::renamed_settings_test {
namespace {

TEST(RenamedSettings, SectionsAndKeysBelowThemAreRenamedTogether) {
  EXPECT_EQ(renamed_setting("stack.plan"), "stack.navigation");
  EXPECT_EQ(renamed_setting("stack.plan.costmap"), "stack.navigation.costmap");
}

TEST(RenamedSettings, KeysMoveBetweenSections) {
  EXPECT_EQ(renamed_setting("stack.plan.recoveries"), "stack.navigation.recovery.behaviors");
  EXPECT_EQ(renamed_setting("stack.plan.paper_local.target_ahead_m"), "stack.navigation.local_planner.dwa_liu21.lookahead_m");
  EXPECT_EQ(renamed_setting("stack.dock_detector.range_std_m"), "stack.docking.detector.range_std_m");
  EXPECT_EQ(renamed_setting("routes.two_swarms.own_pull"), "routes.dual_swarm_pso.cognitive_weight");
}

// The old selector has the name of a section of today.
TEST(RenamedSettings, ASelectorDiffersFromTheSectionOfItsOldName) {
  EXPECT_EQ(renamed_setting("stack.plan.local_planner"), "stack.navigation.local_planner.method");
  EXPECT_EQ(renamed_setting("stack.navigation.local_planner.dwa"), "stack.navigation.local_planner.dwa");
}

TEST(RenamedSettings, KeysThatKeepTheirNameAreReturnedUnchanged) {
  EXPECT_EQ(renamed_setting("stack.navigation.costmap"), "stack.navigation.costmap");
  EXPECT_EQ(renamed_setting("planner"), "planner");
  EXPECT_EQ(renamed_setting(""), "");
}

}  // namespace
}  // namespace patrol::io::renamed_settings_test
