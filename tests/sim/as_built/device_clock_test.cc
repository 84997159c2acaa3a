#include "sim/as_built/device_clock.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::sim::device_clock_test {
namespace {

TEST(DeviceClock, PerfectClockKeepsEveryStampAndDelaysNothing) {
  const DeviceClock clock;
  EXPECT_EQ(clock.stamp(from_seconds(1234.567)), from_seconds(1234.567));
  EXPECT_EQ(clock.transport_delay(5), Time{});
}

TEST(DeviceClock, OffsetOfTwoMillisecondsAndTwentyPpmGiveTwentyTwoMillisecondsAfterAThousandSeconds) {
  const DeviceClock clock(0.002, 20e-6, 0.0, 1, "lidar");
  EXPECT_NEAR(to_seconds(clock.stamp(from_seconds(1000.0))), 1000.022, 1e-9);
  EXPECT_NEAR(to_seconds(clock.stamp(Time{})), 0.002, 1e-9);
}

TEST(DeviceClock, StampsAreNeverNegative) {
  const DeviceClock clock(-0.5, 0.0, 0.0, 1, "lidar");
  EXPECT_EQ(clock.stamp(from_seconds(0.1)), Time{});
}

TEST(DeviceClock, TransportDelayIsExponentialWithItsMean) {
  const DeviceClock clock(0.0, 0.0, 0.001, 3, "lidar");
  double sum = 0.0, squares = 0.0;
  constexpr int kMessages = 20000;
  for (int i = 0; i < kMessages; ++i) {
    const double delay_s = to_seconds(clock.transport_delay(static_cast<std::uint64_t>(i)));
    EXPECT_GE(delay_s, 0.0);
    sum += delay_s;
    squares += delay_s * delay_s;
  }
  const double mean = sum / kMessages;
  EXPECT_NEAR(mean, 0.001, 0.00003);
  EXPECT_NEAR(std::sqrt(squares / kMessages - mean * mean), 0.001, 0.00005);  // the deviation equals the mean
}

}  // namespace
}  // namespace patrol::sim::device_clock_test
