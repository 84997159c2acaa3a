#include "core/text.h"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace patrol::text_test {
namespace {

TEST(Join, PutsTheSeparatorBetweenTheParts) {
  EXPECT_EQ(join(std::vector<std::string>{"a", "b", "c"}, ", "), "a, b, c");
  EXPECT_EQ(join(std::array<const char*, 2>{"x", "y"}, ""), "xy");
}

TEST(Join, OfOnePartIsThePart) { EXPECT_EQ(join(std::vector<std::string>{"a"}, ", "), "a"); }

TEST(Join, KeepsEmptyParts) { EXPECT_EQ(join(std::vector<std::string_view>{"", "a", ""}, ","), ",a,"); }

TEST(Join, OfNothingIsEmpty) { EXPECT_EQ(join(std::vector<std::string>{}, ","), ""); }

}  // namespace
}  // namespace patrol::text_test
