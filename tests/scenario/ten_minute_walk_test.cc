#include <gtest/gtest.h>

#include "tests/support/simulated_quadruped.h"

/// The whole range of commands for ten minutes: -0.3 to 1.0 m/s, +-1 rad/s, starts, stops, turns in place.
namespace patrol::sim::ten_minute_walk_test {
namespace {

struct Stretch {
  double duration_s, vx_mps, yaw_rate_radps;
};

constexpr Stretch kRound[] = {{2.0, 0.0, 0.0},   {10.0, 0.5, 0.0}, {8.0, 1.0, 0.0},  {5.0, 0.0, 1.0},
                              {3.0, 0.0, 0.0},   {6.0, -0.3, 0.0}, {10.0, 0.7, 0.4}, {5.0, 0.0, -1.0},
                              {10.0, 0.7, -0.4}, {1.0, 0.0, 0.0}};  // one minute

TEST(TenMinuteWalk, TenRoundsOfStartsTurnsAndStopsWithoutAFallOrTiltingSixteenDegrees) {
  WalkingRobot robot(make_flat_world());
  for (int round = 0; round < 10; ++round) {
    for (const Stretch& stretch : kRound) {
      const WalkReport report = robot.walk(stretch.vx_mps, 0.0, stretch.yaw_rate_radps, stretch.duration_s);
      ASSERT_FALSE(report.has_fallen) << "round " << round << ", " << stretch.vx_mps << " m/s, "
                                      << stretch.yaw_rate_radps << " rad/s";
      EXPECT_LT(report.max_tilt_rad, 0.28)
          << "round " << round << ", " << stretch.vx_mps << " m/s, " << stretch.yaw_rate_radps << " rad/s";
    }
  }
}

}  // namespace
}  // namespace patrol::sim::ten_minute_walk_test
