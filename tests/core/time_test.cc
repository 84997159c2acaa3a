#include "core/time.h"

#include <gtest/gtest.h>

namespace patrol::time_test {
namespace {

using namespace std::chrono_literals;

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(from_seconds(0.002), 2ms);
  EXPECT_EQ(from_seconds(0.1), 100ms);
  EXPECT_EQ(from_seconds(1.4e-9), 1ns);
  EXPECT_EQ(from_seconds(-1.6e-9), Time{-2});
}

TEST(Time, ThereAndBackIsExactForADayOfTicks) {
  for (Time t{}; t < 24h; t += 7h + 123'456'789ns) EXPECT_EQ(from_seconds(to_seconds(t)), t);
}

}  // namespace
}  // namespace patrol::time_test
