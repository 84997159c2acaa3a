#include "io/yaml/renamed_settings.h"

#include <gtest/gtest.h>

namespace patrol::io::renamed_settings_test {
namespace {

TEST(RenamedSettings, SectionsAndKeysBelowThemAreRenamedTogether) {
  EXPECT_EQ(renamed_setting("stack.plan"), "stack.navigation");
  EXPECT_EQ(renamed_setting("stack.plan.costmap"), "stack.navigation.costmap");
}

TEST(RenamedSettings, KeysThatKeepTheirNameAreReturnedUnchanged) {
  EXPECT_EQ(renamed_setting("stack.navigation.costmap"), "stack.navigation.costmap");
  EXPECT_EQ(renamed_setting("planner"), "planner");
  EXPECT_EQ(renamed_setting(""), "");
}

}  // namespace
}  // namespace patrol::io::renamed_settings_test
