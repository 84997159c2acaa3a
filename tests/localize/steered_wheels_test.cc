#include "localize/steered_wheels.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::localize::steered_wheels_test {
namespace {

constexpr double kFrontRadius_m = 0.12, kRearRadius_m = 0.1, kGauge_m = 0.6, kWheelbase_m = 0.7, kRear_m = -0.3;
constexpr double kTicksPerTurn = 16384.0;
constexpr double kTicksPerMeter = kTicksPerTurn / (2.0 * std::numbers::pi * kRearRadius_m);

/// Robot with a rear axle without motors and driven steered front wheels. The steering joint of the right wheel turns
/// to the right, and its wheel turns backward when the robot drives forward.
RobotDescription make_front_drive() {
  RobotDescription robot;
  robot.name = "front_drive";
  for (const double x : {kRear_m, kRear_m + kWheelbase_m}) {
    for (const double y : {0.5 * kGauge_m, -0.5 * kGauge_m}) {
      WheelGeometry wheel{.link = "w", .center_in_body = {x, y, 0.0}, .radius_m = kRearRadius_m};
      if (x > kRear_m) {
        wheel.radius_m = kFrontRadius_m;
        wheel.drive_joint = robot.joint_names.size();
        wheel.steering_joint = robot.joint_names.size() + 1;
        wheel.forward_sign = wheel.left_sign = y > 0.0 ? 1.0 : -1.0;
        robot.joint_names.insert(robot.joint_names.end(), {"drive", "steer"});
      }
      robot.wheels.push_back(wheel);
    }
  }
  return robot;
}

/// Counts of a robot whose front wheels roll without slip.
class RollingDrive {
 public:
  /// `radius_ratio`: radius of the left wheel relative to its description.
  explicit RollingDrive(double radius_ratio = 1.0) : left_radius_m_(radius_ratio * kFrontRadius_m) {}

  /// Moves the middle of the rear axle ahead and turns, in one interval of the encoders.
  void move(double ahead_m, double turn_rad) {
    const RobotDescription robot = make_front_drive();
    for (const WheelGeometry& wheel : robot.wheels) {
      if (!wheel.drive_joint) continue;
      const double direction = ahead_m < 0.0 ? -1.0 : 1.0;
      const Eigen::Vector2d rolled_m(ahead_m - turn_rad * wheel.center_in_body.y(), turn_rad * kWheelbase_m);
      position_rad_[*wheel.steering_joint] =
          wheel.left_sign * std::atan2(direction * rolled_m.y(), direction * rolled_m.x());
      const double radius_m = wheel.is_left() ? left_radius_m_ : kFrontRadius_m;
      position_rad_[*wheel.drive_joint] += wheel.forward_sign * direction * rolled_m.norm() / radius_m;
    }
    time_s_ += 0.02;
    last_ = read();
  }

  /// Repeats a motion; the first interval, in which the wheels steer, is not counted.
  void start(double ahead_m, double turn_rad) {
    move(ahead_m, turn_rad);
    first_ = last_;
  }

  double left_m() const { return static_cast<double>(last_.left - first_.left) / kTicksPerMeter; }
  double right_m() const { return static_cast<double>(last_.right - first_.right) / kTicksPerMeter; }
  double residual_m() const { return static_cast<double>(last_.residual - first_.residual) / kTicksPerMeter; }
  DriveTicks read() {
    return wheels_.add(
        {.stamp = from_seconds(time_s_), .position_rad = position_rad_, .velocity_radps = {}, .effort_nm = {}});
  }

 private:
  double left_radius_m_, time_s_ = 0.0;
  std::vector<double> position_rad_ = std::vector<double>(4, 0.0);
  SteeredWheels wheels_{make_front_drive(), kTicksPerTurn, 1.0};
  DriveTicks last_ = read(), first_ = last_;
};

TEST(SteeredWheels, ACircleOf2MetersIsThatOfTheRearWheelsAheadAndInReverseTo1Millimeter) {
  constexpr double kCircle_m = 2.0;
  constexpr int kSteps = 1000;
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  for (const double side : {1.0, -1.0}) {
    for (const double direction : {1.0, -1.0}) {
      const double ahead_m = direction * kTurn_rad * kCircle_m / kSteps,
                   turn_rad = side * direction * kTurn_rad / kSteps;
      RollingDrive drive;
      drive.start(ahead_m, turn_rad);
      for (int step = 0; step < kSteps; ++step) drive.move(ahead_m, turn_rad);
      const double half_m = 0.5 * side * kGauge_m;
      EXPECT_NEAR(drive.left_m(), direction * kTurn_rad * (kCircle_m - half_m), 1e-3) << side << ", " << direction;
      EXPECT_NEAR(drive.right_m(), direction * kTurn_rad * (kCircle_m + half_m), 1e-3) << side << ", " << direction;
      EXPECT_NEAR(drive.residual_m(), 0.0, 1e-3);
    }
  }
}

TEST(SteeredWheels, ASlalomEndsAtItsDistanceTo1PerMilleAndItsHeadingTo1Degree) {
  RollingDrive drive;
  drive.start(0.02, 0.0);
  double distance_m = 0.0, heading_rad = 0.0;
  for (int step = 0; step < 1000; ++step) {
    const double ahead_m = 0.02, turn_rad = 0.008 * std::sin(0.01 * step);
    drive.move(ahead_m, turn_rad);
    distance_m += ahead_m;
    heading_rad += turn_rad;
  }
  EXPECT_GT(heading_rad, 1.0);
  EXPECT_NEAR(0.5 * (drive.left_m() + drive.right_m()), distance_m, 1e-3 * distance_m);
  EXPECT_NEAR((drive.right_m() - drive.left_m()) / kGauge_m, heading_rad, to_rad(1.0));
}

// The rows of a straight motion are v + a w, v - a w and, for each wheel, L w, where 2 a is the gauge. The row of the
// left wheel has the error e: w = -a e / (2 (a^2 + L^2)), and v has the error e / 2.
TEST(SteeredWheels, OneWheelThatIsLargerBy2PercentShortensTheWayBy1PercentAndIsAResidual) {
  RollingDrive drive(1.02);
  for (int step = 0; step < 500; ++step) drive.move(0.02, 0.0);
  const double error_m = 10.0 * (1.0 / 1.02 - 1.0), half_m = 0.5 * kGauge_m;
  const double turn_rad = -half_m * error_m / (2.0 * (half_m * half_m + kWheelbase_m * kWheelbase_m));
  EXPECT_NEAR(0.5 * (drive.left_m() + drive.right_m()), 10.0 + 0.5 * error_m, 1e-3);
  EXPECT_NEAR((drive.right_m() - drive.left_m()) / kGauge_m, turn_rad, 1e-3);
  const double rest_m = 0.5 * error_m + half_m * turn_rad, side_m = kWheelbase_m * turn_rad;
  EXPECT_NEAR(std::abs(drive.residual_m()), std::sqrt(0.5 * (rest_m * rest_m + side_m * side_m)), 1e-3);
}

TEST(SteeredWheels, WheelsThatSteerAtStandstillCountNothing) {
  SteeredWheels wheels(make_front_drive(), kTicksPerTurn, 1.0);
  wheels.add(
      {.stamp = from_seconds(0.0), .position_rad = {3.0, 0.1, -2.0, -0.1}, .velocity_radps = {}, .effort_nm = {}});
  const DriveTicks ticks = wheels.add(
      {.stamp = from_seconds(0.02), .position_rad = {3.0, 0.3, -2.0, -0.4}, .velocity_radps = {}, .effort_nm = {}});
  EXPECT_EQ(ticks.left, 0);
  EXPECT_EQ(ticks.right, 0);
  EXPECT_EQ(ticks.residual, 0);
}

TEST(SteeredWheels, ReadingsThatAreNotNewerCountNothing) {
  SteeredWheels wheels(make_front_drive(), kTicksPerTurn, 1.0);
  const auto left_after = [&wheels](double time_s, double turn_rad) {
    const DriveTicks ticks = wheels.add({.stamp = from_seconds(time_s),
                                         .position_rad = {turn_rad, 0.0, -turn_rad, 0.0},
                                         .velocity_radps = {},
                                         .effort_nm = {}});
    return static_cast<double>(ticks.left);
  };
  left_after(1.0, 0.0);
  EXPECT_EQ(left_after(1.0, 1.0), 0.0);
  EXPECT_NEAR(left_after(1.1, 1.0), kFrontRadius_m * kTicksPerMeter, 1.0);
}

TEST(SteeredWheels, NeedsDrivenWheelsOnBothSidesThatAreAllSteeredAndNotOnTheFixedAxle) {
  const auto message_of = [](const RobotDescription& robot) {
    return [&robot] { SteeredWheels(robot, kTicksPerTurn, 1.0); };
  };
  RobotDescription one = make_front_drive(), rear = make_front_drive(), middle = make_front_drive();
  EXPECT_TRUE(is_driven_by_steered_wheels(one));
  one.wheels.back().drive_joint.reset();
  EXPECT_FALSE(is_driven_by_steered_wheels(one));
  EXPECT_THAT(message_of(one), testing::ThrowsMessage<InputError>(testing::HasSubstr("all steered")));
  rear.wheels[0].drive_joint = rear.wheels[1].drive_joint = 0;
  EXPECT_FALSE(is_driven_by_steered_wheels(rear));
  middle.wheels.back().center_in_body.x() = kRear_m;
  EXPECT_THAT(message_of(middle), testing::ThrowsMessage<InputError>(testing::HasSubstr("must not be on the axle")));
}

}  // namespace
}  // namespace patrol::localize::steered_wheels_test
