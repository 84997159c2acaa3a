#include "stack/sensors/clock_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/late_lidar.h"

namespace patrol::stack::clock_monitor_test {
namespace {

using ::testing::HasSubstr;

constexpr double kLag_s = 0.001;  // mean lag of odometry, with which the offsets of the estimator appear earlier

Time seconds(double s) { return from_seconds(s); }

ClockMonitorSettings without_lag() {
  ClockMonitorSettings settings;
  settings.odometry_lag_s = 0.0;
  return settings;
}

TEST(ClockMonitor, ReportsAnOffsetAboveFiveMillisecondsThatIsCorrected) {
  ClockMonitor monitor(without_lag());
  const auto change = monitor.step(seconds(1.0), {.offset_s = -0.02, .noise_std_s = 0.001});
  ASSERT_TRUE(change);
  EXPECT_EQ(change->sensor, "lidar");
  EXPECT_FALSE(change->has_recovered);
  EXPECT_EQ(change->text, "Sensor lidar has stamps 20.0 ms early against odometry: corrected.");
  EXPECT_TRUE(monitor.can_drive());
  EXPECT_FALSE(monitor.step(seconds(2.0), {.offset_s = -0.021, .noise_std_s = 0.001}));
}

TEST(ClockMonitor, WaitsUntilTheEstimateIsCertain) {
  ClockMonitor monitor(without_lag());
  EXPECT_FALSE(monitor.step(seconds(1.0), {.offset_s = 0.02, .noise_std_s = 0.006}));
  EXPECT_TRUE(monitor.step(seconds(2.0), {.offset_s = 0.02, .noise_std_s = 0.004}));
}

/// Returns whether an offset is reported within 60 s of walking, by the estimates from scans and odometry.
bool is_reported(double offset_s, std::uint64_t seed) {
  localize::TimeOffsetEstimator estimator({});
  ClockMonitor monitor({});
  bool is_reported = false;
  test::LateLidar(seed, test::walking, {.jitter_s = 0.0005})
      .run_applied(estimator, offset_s - kLag_s, 60, [&](int second) {
        const LidarClock clock = lidar_clock_by(estimator.at(seconds(second)), estimator.num_steps());
        is_reported |= monitor.step(seconds(second), clock).has_value();
      });
  return is_reported;
}

TEST(ClockMonitor, ReportsEstimatedOffsetsOf6500MicrosecondsButNotOf4Milliseconds) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_FALSE(is_reported(sign * 0.004, seed)) << sign << ", seed " << seed;
      EXPECT_TRUE(is_reported(sign * 0.0065, seed)) << sign << ", seed " << seed;
      EXPECT_TRUE(is_reported(sign * 0.007, seed)) << sign << ", seed " << seed;
    }
  }
}

TEST(ClockMonitor, StopsForAnOffsetThatCannotBeCorrected) {
  ClockMonitor monitor(without_lag());
  const auto change = monitor.step(seconds(1.0), {.offset_s = 0.16, .noise_std_s = 0.002});
  ASSERT_TRUE(change);
  EXPECT_THAT(change->text, HasSubstr("160.0 ms late"));
  EXPECT_THAT(change->text, HasSubstr("robot stopped"));
  EXPECT_FALSE(monitor.can_drive());
}

// An hour of two clocks of 20 ppm.
TEST(ClockMonitor, GoesOnWithAnOffsetOf144Milliseconds) {
  ClockMonitor monitor(without_lag());
  EXPECT_TRUE(monitor.step(seconds(1.0), {.offset_s = 0.144, .noise_std_s = 0.002}));
  EXPECT_TRUE(monitor.can_drive());
}

TEST(ClockMonitor, StopsForAClockThatStepsAgainAndAgain) {
  ClockMonitor monitor(without_lag());
  for (int step = 1; step <= 2; ++step) {
    EXPECT_FALSE(monitor.step(seconds(10.0 * step), {.offset_s = 0.0, .noise_std_s = 0.001, .num_steps = step}));
    EXPECT_TRUE(monitor.can_drive());
  }
  const auto change = monitor.step(seconds(30.0), {.offset_s = 0.0, .noise_std_s = 0.001, .num_steps = 3});
  ASSERT_TRUE(change);
  EXPECT_THAT(change->text, HasSubstr("change by steps"));
  EXPECT_FALSE(monitor.can_drive());
  EXPECT_TRUE(monitor.step(seconds(95.0), {.offset_s = 0.0, .noise_std_s = 0.001, .num_steps = 3}));
  EXPECT_TRUE(monitor.can_drive());
}

TEST(ClockMonitor, RecoversWhenTheStampsAgreeAgain) {
  ClockMonitor monitor(without_lag());
  EXPECT_TRUE(monitor.step(seconds(1.0), {.offset_s = 0.01, .noise_std_s = 0.001}));
  EXPECT_FALSE(monitor.step(seconds(2.0), {.offset_s = 0.004, .noise_std_s = 0.001}));
  const auto change = monitor.step(seconds(3.0), {.offset_s = 0.001, .noise_std_s = 0.001});
  ASSERT_TRUE(change);
  EXPECT_TRUE(change->has_recovered);
}

}  // namespace
}  // namespace patrol::stack::clock_monitor_test
