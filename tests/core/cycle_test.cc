#include "core/cycle.h"

#include <gtest/gtest.h>

namespace patrol::cycle_test {
namespace {

constexpr Time ms(int count) { return std::chrono::milliseconds(count); }

TEST(NextInCycle, IsOnePeriodLaterWhenOnTime) {
  EXPECT_EQ(next_in_cycle(ms(100), ms(50), ms(100)), ms(150));
  EXPECT_EQ(next_in_cycle(ms(100), ms(50), ms(149)), ms(150));
}

TEST(NextInCycle, SkipsMissedCyclesAndKeepsThePhase) {
  EXPECT_EQ(next_in_cycle(ms(0), ms(50), ms(1502)), ms(1550));
  EXPECT_EQ(next_in_cycle(ms(10), ms(50), ms(1510)), ms(1560));
}

}  // namespace
}  // namespace patrol::cycle_test
