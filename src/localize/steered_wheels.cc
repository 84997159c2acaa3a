#include "localize/steered_wheels.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "core/wheel_kinematics.h"

namespace patrol::localize {
namespace {

constexpr double kMinWheelbase_m = 0.01;

}  // namespace

bool is_driven_by_steered_wheels(const RobotDescription& robot) {
  bool is_left = false, is_right = false;
  for (const WheelGeometry& wheel : robot.wheels) {
    if (!wheel.drive_joint) continue;
    if (!wheel.steering_joint) return false;
    (wheel.is_left() ? is_left : is_right) = true;
  }
  return is_left && is_right;
}

SteeredWheels::SteeredWheels(const RobotDescription& robot, double ticks_per_turn, double gauge_ratio) {
  const DifferentialGeometry axle = differential_geometry(robot);
  half_gauge_m_ = 0.5 * axle.gauge_m * gauge_ratio;
  ticks_per_m_ = ticks_per_turn / (2.0 * std::numbers::pi * axle.rolling_radius_m);
  if (!is_driven_by_steered_wheels(robot))
    throw InputError(fmt::format("robot {}: has no driven wheels on both sides that are all steered", robot.name));
  for (const WheelGeometry& wheel : robot.wheels) {
    if (!wheel.drive_joint) continue;
    wheels_.push_back({.p_m = wheel.center_in_body.head<2>() - Eigen::Vector2d(axle.middle_x_m, 0.0),
                       .radius_m = wheel.radius_m,
                       .forward_sign = wheel.forward_sign,
                       .left_sign = wheel.left_sign,
                       .drive_joint = *wheel.drive_joint,
                       .steering_joint = *wheel.steering_joint});
    if (std::abs(wheels_.back().p_m.x()) < kMinWheelbase_m)
      throw InputError(
          fmt::format("robot {}: wheel {} is steered and driven: must not be on the axle that is not steered",
                      robot.name, wheel.link));
  }
}

DriveTicks SteeredWheels::add(const JointState& joints) {
  if (!stamp_ || joints.stamp > *stamp_) {
    if (stamp_) move(joints.position_rad);
    last_rad_ = joints.position_rad;
    stamp_ = joints.stamp;
  }
  const auto ticks = [this](double distance_m) { return std::llround(distance_m * ticks_per_m_); };
  return {joints.stamp, ticks(left_m_), ticks(right_m_), 0, ticks(residual_m_)};
}

void SteeredWheels::move(const std::vector<double>& angle_rad) {
  const auto num_wheels = static_cast<Eigen::Index>(wheels_.size());
  Eigen::MatrixX2d rows(2 * num_wheels, 2);
  Eigen::VectorXd rolled_m = Eigen::VectorXd::Zero(2 * num_wheels);
  for (Eigen::Index i = 0; i < num_wheels; ++i) {
    const Wheel& wheel = wheels_[static_cast<std::size_t>(i)];
    const double steering_rad =
        0.5 * wheel.left_sign * (last_rad_[wheel.steering_joint] + angle_rad[wheel.steering_joint]);
    const double c = std::cos(steering_rad), s = std::sin(steering_rad);
    rows.row(2 * i) << c, wheel.p_m.x() * s - wheel.p_m.y() * c;
    rows.row(2 * i + 1) << -s, wheel.p_m.x() * c + wheel.p_m.y() * s;
    rolled_m[2 * i] =
        wheel.radius_m * wheel.forward_sign * (angle_rad[wheel.drive_joint] - last_rad_[wheel.drive_joint]);
  }
  const Eigen::Vector2d motion =
      solve_symmetric(Eigen::Matrix2d(rows.transpose() * rows), Eigen::Vector2d(rows.transpose() * rolled_m));
  const Eigen::VectorXd rest_m = rolled_m - rows * motion;
  left_m_ += motion[0] - half_gauge_m_ * motion[1];
  right_m_ += motion[0] + half_gauge_m_ * motion[1];
  residual_m_ += std::copysign(rest_m.norm() / std::sqrt(static_cast<double>(rows.rows())), rest_m[0]);
}

}  // namespace patrol::localize
