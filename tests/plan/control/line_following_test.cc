#include "plan/control/line_following.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/plan/tracked_plant.h"

namespace patrol::plan::line_following_test {
namespace {

constexpr double kExactTol = 1e-12;

TEST(LineFollowing, OnTheLineDrivesStraight) {
  const VelocityCommand command = follow_line({}, {-2.0, 0.0, 0.0}, 0.3);
  EXPECT_NEAR(command.vx_mps, 0.3, kExactTol);
  EXPECT_NEAR(command.yaw_rate_radps, 0.0, kExactTol);
  EXPECT_EQ(command.vy_mps, 0.0);
}

// 0.1 m to the left, gain 3 per metre: the heading aimed at is -atan(0.3), two per second of that is commanded.
TEST(LineFollowing, AimsAtMinusTheArcTangentOfGainTimesSide) {
  const LineFollowingSettings settings{.lateral_gain_per_m = 3.0, .yaw_gain_per_s = 0.5};
  EXPECT_NEAR(follow_line(settings, {-1.0, 0.1, 0.0}, 0.2).yaw_rate_radps, -0.5 * std::atan(0.3), kExactTol);
  EXPECT_NEAR(follow_line(settings, {-1.0, 0.1, 0.0}, -0.2).yaw_rate_radps, 0.5 * std::atan(0.3), kExactTol);
}

TEST(LineFollowing, NeverAimsSteeperThanItsLimit) {
  const LineFollowingSettings settings{.max_angle_rad = 0.4};
  EXPECT_NEAR(line_heading_rad(settings, 50.0, 1.0), -0.4, kExactTol);
  EXPECT_NEAR(line_heading_rad(settings, -50.0, 1.0), 0.4, kExactTol);
}

TEST(LineFollowing, TurnedAwayByARightAngleTurnsBeforeItDrives) {
  const VelocityCommand command = follow_line({}, {-1.0, 0.0, std::numbers::pi / 2.0}, 0.3);
  EXPECT_NEAR(command.vx_mps, 0.0, kExactTol);
  EXPECT_EQ(command.yaw_rate_radps, -LineFollowingSettings{}.max_yaw_rate_radps);
}

// With a heading loop much faster than the drive, 0.1 m aside becomes 0.1 exp(-3 x 0.6) m after 0.6 m, whatever the
// speed.
TEST(LineFollowing, TheSideErrorFallsWithTheWayDriven) {
  const LineFollowingSettings settings{.lateral_gain_per_m = 3.0, .yaw_gain_per_s = 10.0, .max_yaw_rate_radps = 3.0};
  for (const double speed : {0.05, 0.1, -0.05}) {
    Pose2 pose{0.0, 0.1, line_heading_rad(settings, 0.1, speed)};
    while (std::abs(pose.x) < 0.6) {
      const VelocityCommand command = follow_line(settings, pose, speed);
      pose = follow_arc(pose, command.vx_mps, command.yaw_rate_radps, 0.01);
    }
    EXPECT_NEAR(pose.y, 0.1 * std::exp(-1.8), 0.002) << speed;
  }
}

// tan(0.5) = 0.546, so from the limit's knee at 0.182 m on the error falls exponentially. From 0.5 m: (0.5 - 0.182) /
// 0.546 = 0.582 m straight, then exp(-3 x 0.418).
TEST(LineFollowing, ForeseesTheSideErrorThatIsLeft) {
  const LineFollowingSettings settings;
  const double knee = std::tan(0.5) / 3.0;
  EXPECT_NEAR(lateral_error_after_m(settings, 0.1, 0.5), 0.1 * std::exp(-1.5), kExactTol);
  EXPECT_NEAR(lateral_error_after_m(settings, -0.1, 0.0), 0.1, kExactTol);
  EXPECT_NEAR(lateral_error_after_m(settings, 0.5, 0.2), 0.5 - 0.2 * std::tan(0.5), kExactTol);
  EXPECT_NEAR(lateral_error_after_m(settings, 0.5, 1.0), knee * std::exp(-3.0 * (1.0 - (0.5 - knee) / std::tan(0.5))),
              kExactTol);
}

}  // namespace
}  // namespace patrol::plan::line_following_test
