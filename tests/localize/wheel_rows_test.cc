#include "localize/wheel_rows.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::localize::wheel_rows_test {
namespace {

constexpr double kRadius_m = 0.1, kGauge_m = 0.5, kTicksPerTurn = 16384.0;
constexpr double kTicksPerMeter = kTicksPerTurn / (2.0 * std::numbers::pi * kRadius_m);

/// Robot with four driven wheels: front left, front right, rear left, rear right. The IMU is turned by 90 degrees about
/// x, and the right wheels turn backward when the robot drives forward.
RobotDescription make_four_wheels() {
  RobotDescription robot;
  robot.name = "four_wheels";
  for (const double x : {0.2, -0.2}) {
    for (const double y : {0.5 * kGauge_m, -0.5 * kGauge_m}) {
      WheelGeometry wheel{.link = "w", .center_in_body = {x, y, 0.0}, .radius_m = kRadius_m};
      wheel.drive_joint = robot.joint_names.size();
      wheel.forward_sign = y > 0.0 ? 1.0 : -1.0;
      robot.joint_names.push_back("j");
      robot.wheels.push_back(wheel);
    }
  }
  robot.T_body_sensor["imu"] = {{0.0, 0.0, 0.1}, quaternion_from_rpy(0.5 * std::numbers::pi, 0.0, 0.0)};
  return robot;
}

/// Feeds rims of constant speed, [wheel] as in make_four_wheels(), and a constant yaw rate.
class Drive {
 public:
  explicit Drive(bool has_gyro = true) : has_gyro_(has_gyro) {}

  /// Returns the counted motion of the two sides, m.
  std::array<double, 2> go(const std::array<double, 4>& speed_mps, double yaw_rate_radps, double duration_s) {
    constexpr double kStep_s = 0.02;
    const TrackTicks before = read();
    TrackTicks after = before;
    const auto num_steps = std::lround(duration_s / kStep_s);
    for (long step = 0; step < num_steps; ++step) {
      time_s_ += kStep_s;
      // z of body is y of this IMU.
      if (has_gyro_)
        rows_.add(Imu{.stamp = from_seconds(time_s_), .angular_velocity_radps = {0.3, yaw_rate_radps, -0.2}});
      for (std::size_t wheel = 0; wheel < 4; ++wheel)
        position_rad_[wheel] += (wheel % 2 == 0 ? 1.0 : -1.0) * kStep_s * speed_mps[wheel] / kRadius_m;
      after = read();
    }
    return {static_cast<double>(after.left - before.left) / kTicksPerMeter,
            static_cast<double>(after.right - before.right) / kTicksPerMeter};
  }

  /// Sets all encoders to zero.
  void restart() { position_rad_.assign(4, 0.0); }

 private:
  TrackTicks read() {
    return rows_.add(
        {.stamp = from_seconds(time_s_), .position_rad = position_rad_, .velocity_radps = {}, .effort_nm = {}});
  }

  bool has_gyro_;
  WheelRows rows_{make_four_wheels(), kTicksPerTurn};
  double time_s_ = 0.0;
  std::vector<double> position_rad_ = {40.0, -30.0, 20.0, -10.0};
};

void expect_near(const std::array<double, 2>& sides_m, double left_m, double right_m, double tolerance_m) {
  EXPECT_NEAR(sides_m[0], left_m, tolerance_m);
  EXPECT_NEAR(sides_m[1], right_m, tolerance_m);
}

TEST(WheelRows, ASideIsTheMeanOfItsWheels) {
  Drive drive;
  expect_near(drive.go({0.60, 0.50, 0.48, 0.62}, 0.0, 10.0), 5.4, 5.6, 1e-3);
}

TEST(WheelRows, ALiftedWheelThatTurnsWhileTheRobotStandsIsNotCounted) {
  for (std::size_t lifted = 0; lifted < 4; ++lifted) {
    for (const double speed_mps : {0.5, -0.3}) {
      Drive drive;
      std::array<double, 4> speeds_mps{};
      speeds_mps[lifted] = speed_mps;
      // The smoothed speeds differ clearly only after some readings.
      expect_near(drive.go(speeds_mps, 0.0, 10.0), 0.0, 0.0, 0.05);
    }
  }
}

TEST(WheelRows, ALiftedWheelAtTheSetSpeedIsNotCountedWhileTheRobotSlidesFaster) {
  Drive drive;
  expect_near(drive.go({0.3, 0.6, 0.6, 0.6}, 0.0, 10.0), 6.0, 6.0, 0.05);
}

TEST(WheelRows, OneLiftedWheelOfEachSideIsNotCountedInATurn) {
  Drive drive;
  const double yaw_rate_radps = 0.6;
  // The wheels with traction turn the robot by the geometric gauge. The lifted ones turn at the set speeds.
  expect_near(drive.go({0.5, 0.55, 0.25, 0.9}, yaw_rate_radps, 10.0), 2.5, 5.5, 0.05);
}

TEST(WheelRows, TheMeanCountsWithoutAGyro) {
  Drive drive(false);
  expect_near(drive.go({0.5, 0.0, 0.0, 0.0}, 0.0, 10.0), 2.5, 0.0, 1e-3);
}

TEST(WheelRows, CountsContinueAfterALiftedWheelTouchesTheGround) {
  Drive drive;
  drive.go({0.5, 0.0, 0.0, 0.0}, 0.0, 10.0);
  drive.go({0.4, 0.4, 0.4, 0.4}, 0.0, 1.0);  // until the smoothed speeds agree
  expect_near(drive.go({0.4, 0.4, 0.4, 0.4}, 0.0, 10.0), 4.0, 4.0, 1e-3);
}

TEST(WheelRows, ARestartOfTheEncodersIsNoLiftedWheel) {
  const std::array<double, 4> speeds_mps = {0.45, 0.35, 0.35, 0.45};
  Drive drive;
  drive.go(speeds_mps, 0.0, 1.0);
  drive.restart();
  drive.go(speeds_mps, 0.0, 0.02);
  expect_near(drive.go(speeds_mps, 0.0, 5.0), 2.0, 2.0, 1e-3);
}

TEST(WheelRows, NeedsDrivenWheelsOnBothSides) {
  RobotDescription robot = make_four_wheels();
  for (WheelGeometry& wheel : robot.wheels) wheel.drive_joint.reset();
  EXPECT_THAT([&] { WheelRows(robot, kTicksPerTurn); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("no driven wheels on both sides")));
}

}  // namespace
}  // namespace patrol::localize::wheel_rows_test
