#include "app/run/compute_delay.h"

#include <gtest/gtest.h>

namespace patrol::app::compute_delay_test {
namespace {

TEST(WarningOfUnused, NamesTheSettingThatTheModelIgnores) {
  EXPECT_EQ(warning_of_unused({.model = "free", .delay_s = 0.3}),
            "stack.compute.delay_s = 0.3: no effect with stack.compute.model = free: needs fixed");
  EXPECT_EQ(warning_of_unused({.model = "fixed", .factor = 20.0}),
            "stack.compute.factor = 20: no effect with stack.compute.model = fixed: needs measured");
}

TEST(WarningOfUnused, IsEmptyForTheDefaultsAndForUsedSettings) {
  EXPECT_EQ(warning_of_unused({}), "");
  EXPECT_EQ(warning_of_unused({.model = "fixed", .delay_s = 0.3}), "");
  EXPECT_EQ(warning_of_unused({.model = "measured", .factor = 20.0}), "");
}

}  // namespace
}  // namespace patrol::app::compute_delay_test
