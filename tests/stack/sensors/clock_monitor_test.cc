#include "stack/sensors/clock_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::stack::clock_monitor_test {
namespace {

using ::testing::HasSubstr;

Time seconds(double s) { return from_seconds(s); }

TEST(ClockMonitor, ReportsAnOffsetAboveFiveMillisecondsThatIsCorrected) {
  ClockMonitor monitor({});
  const auto change = monitor.step(seconds(1.0), {.offset_s = -0.02, .std_s = 0.001});
  ASSERT_TRUE(change);
  EXPECT_EQ(change->sensor, "lidar");
  EXPECT_FALSE(change->has_recovered);
  EXPECT_EQ(change->text, "Sensor lidar has stamps 20.0 ms early against odometry: corrected.");
  EXPECT_TRUE(monitor.can_drive());
  EXPECT_FALSE(monitor.step(seconds(2.0), {.offset_s = -0.021, .std_s = 0.001}));
}

TEST(ClockMonitor, WaitsUntilTheEstimateIsCertain) {
  ClockMonitor monitor({});
  EXPECT_FALSE(monitor.step(seconds(1.0), {.offset_s = 0.02, .std_s = 0.006}));
  EXPECT_TRUE(monitor.step(seconds(2.0), {.offset_s = 0.02, .std_s = 0.004}));
}

// Offsets of 4 ms, estimated with honest errors, are not reported; offsets of 10 ms are.
TEST(ClockMonitor, SeparatesOffsetsOnBothSidesOfTheLimit) {
  int num_false = 0, num_missed = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const double error_s = 0.001 * RandomStream(seed, "error").normal(0);
    ClockMonitor small({}), large({});
    num_false += small.step(seconds(1.0), {.offset_s = 0.004 + error_s, .std_s = 0.001}).has_value() ? 1 : 0;
    num_missed += large.step(seconds(1.0), {.offset_s = -0.01 + error_s, .std_s = 0.001}).has_value() ? 0 : 1;
  }
  EXPECT_EQ(num_false, 0);
  EXPECT_LE(num_missed, 5);
}

TEST(ClockMonitor, StopsForAnOffsetThatCannotBeCorrected) {
  ClockMonitor monitor({});
  const auto change = monitor.step(seconds(1.0), {.offset_s = 0.16, .std_s = 0.002});
  ASSERT_TRUE(change);
  EXPECT_THAT(change->text, HasSubstr("160.0 ms late"));
  EXPECT_THAT(change->text, HasSubstr("robot stopped"));
  EXPECT_FALSE(monitor.can_drive());
}

// An hour of two clocks of 20 ppm.
TEST(ClockMonitor, GoesOnWithAnOffsetOf144Milliseconds) {
  ClockMonitor monitor({});
  EXPECT_TRUE(monitor.step(seconds(1.0), {.offset_s = 0.144, .std_s = 0.002}));
  EXPECT_TRUE(monitor.can_drive());
}

TEST(ClockMonitor, StopsForAClockThatStepsAgainAndAgain) {
  ClockMonitor monitor({});
  for (int step = 1; step <= 2; ++step) {
    EXPECT_FALSE(monitor.step(seconds(10.0 * step), {.offset_s = 0.0, .std_s = 0.001, .num_steps = step}));
    EXPECT_TRUE(monitor.can_drive());
  }
  const auto change = monitor.step(seconds(30.0), {.offset_s = 0.0, .std_s = 0.001, .num_steps = 3});
  ASSERT_TRUE(change);
  EXPECT_THAT(change->text, HasSubstr("change by steps"));
  EXPECT_FALSE(monitor.can_drive());
  EXPECT_TRUE(monitor.step(seconds(95.0), {.offset_s = 0.0, .std_s = 0.001, .num_steps = 3}));
  EXPECT_TRUE(monitor.can_drive());
}

TEST(ClockMonitor, RecoversWhenTheStampsAgreeAgain) {
  ClockMonitor monitor({});
  EXPECT_TRUE(monitor.step(seconds(1.0), {.offset_s = 0.01, .std_s = 0.001}));
  EXPECT_FALSE(monitor.step(seconds(2.0), {.offset_s = 0.004, .std_s = 0.001}));
  const auto change = monitor.step(seconds(3.0), {.offset_s = 0.001, .std_s = 0.001});
  ASSERT_TRUE(change);
  EXPECT_TRUE(change->has_recovered);
}

}  // namespace
}  // namespace patrol::stack::clock_monitor_test
