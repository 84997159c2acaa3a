#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "core/wheel_kinematics.h"
#include "localize/track_odometry.h"

// The odometry of tracks with mecanum wheels, on level ground without slip.
namespace patrol::localize::track_odometry_mecanum_test {
namespace {

constexpr double kRadius_m = 0.1;

RobotDescription make_mecanum_robot() {
  RobotDescription robot;
  robot.name = "mecanum";
  for (const double x : {0.2, -0.2}) {
    for (const double y : {0.25, -0.25}) {
      WheelGeometry wheel{.link = "w", .center_in_body = {x, y, 0.0}, .radius_m = kRadius_m};
      wheel.drive_joint = robot.joint_names.size();
      robot.joint_names.push_back("j");
      robot.joint_limits.push_back({.velocity_radps = 20.0, .effort_nm = 10.0});
      robot.wheels.push_back(wheel);
    }
  }
  robot.T_body_sensor["imu"] = {};
  add_rollers(RollerPattern::kX, 0.25 * std::numbers::pi, robot);
  return robot;
}

/// Rest of 4 s, then a lateral motion to the left that accelerates for 1 s to 0.4 m/s. `residual_mps`: speed of the
/// wheels that contradicts it.
class LateralDrive {
 public:
  explicit LateralDrive(double residual_mps = 0.0) : residual_mps_(residual_mps) {
    settings_.ticks_per_sprocket_turn = 16384.0;
    settings_.skid_ratio = 0.0;
    odometry_.emplace(make_mecanum_robot(), settings_);
  }

  void run(double until_s) {
    constexpr double kStep_s = 0.004, kRest_s = 4.0, kMax_mps = 0.4;
    const double ticks_per_m = settings_.ticks_per_sprocket_turn / (2.0 * std::numbers::pi * kRadius_m);
    for (; time_s_ < until_s; ++step_) {
      time_s_ = kStep_s * static_cast<double>(step_);
      const bool accelerates = time_s_ > kRest_s && speed_mps_ < kMax_mps - 1e-9;
      speed_mps_ += accelerates ? kStep_s * kMax_mps : 0.0;
      y_m_ += kStep_s * speed_mps_;
      residual_m_ += speed_mps_ > 0.0 ? kStep_s * residual_mps_ : 0.0;
      const double dither = step_ % 2 == 0 ? 1e-4 : -1e-4;  // equal readings would be taken for a frozen sensor
      odometry_->add(Imu{.stamp = from_seconds(time_s_),
                         .angular_velocity_radps = {0.0, 0.0, dither},
                         .linear_acceleration_mps2 = {dither, accelerates ? kMax_mps : 0.0, 9.81}});
      if (step_ % 5 != 0) continue;
      odometry_->add(DriveTicks(from_seconds(time_s_), 0, 0, std::llround(y_m_ * ticks_per_m),
                                std::llround(residual_m_ * ticks_per_m)));
    }
  }
  const TrackOdometry& odometry() const { return *odometry_; }
  double y_m() const { return y_m_; }

 private:
  TrackOdometrySettings settings_;
  double residual_mps_;
  std::optional<TrackOdometry> odometry_;
  long step_ = 1;
  double time_s_ = 0.0, speed_mps_ = 0.0, y_m_ = 0.0, residual_m_ = 0.0;
};

TEST(MecanumTrackOdometry, ALateralMotionOf10MetersIsMeasuredTo1CentimeterWithoutForwardMotion) {
  LateralDrive drive;
  drive.run(29.5);
  const Pose3 pose = drive.odometry().estimate().value().T_odom_body;
  EXPECT_GT(drive.y_m(), 9.9);
  EXPECT_NEAR(pose.position.y(), drive.y_m(), 0.01);
  EXPECT_NEAR(pose.position.x(), 0.0, 0.01);
  EXPECT_FALSE(drive.odometry().health().is_slipping);
}

// 1 % of cross slip over 10 m with a correlation length of 3 m: 0.01 sqrt(2 x 3 x 10) = 7.7 cm across the motion.
TEST(MecanumTrackOdometry, TheStandardDeviationAcrossALateralMotionIsAtLeastThatOfTheCrossSlip) {
  LateralDrive drive;
  drive.run(29.5);
  const Eigen::Matrix3d P = drive.odometry().estimate().value().planar_covariance;
  EXPECT_GT(std::sqrt(P(0, 0)), 0.077);
  EXPECT_LT(std::sqrt(P(0, 0)), 0.2);
  EXPECT_NEAR(drive.odometry().twist_std().x(), 0.01 * 0.4, 0.005);
}

TEST(MecanumTrackOdometry, WheelsThatContradictEachOtherBy0_1MetersPerSecondRaiseTheStandardDeviationOfTheSpeed) {
  LateralDrive clean, slipping(0.1);
  clean.run(10.0);
  slipping.run(10.0);
  const auto speed_std = [](const LateralDrive& drive) {
    constexpr int kLateral = InertialError::kVelocity + 1;
    return std::sqrt(drive.odometry().filter()->covariance()(kLateral, kLateral));
  };
  EXPECT_GT(speed_std(slipping), 1.5 * speed_std(clean));
}

}  // namespace
}  // namespace patrol::localize::track_odometry_mecanum_test
