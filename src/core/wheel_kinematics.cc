#include "core/wheel_kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "core/skid_spread.h"

namespace patrol {
namespace {

constexpr double kStanding_mps = 1e-3;  // slower wheels have no direction
constexpr double kPoint_m = 1e-6;       // shorter sides touch the ground in a point

bool is_any_driven(const RobotDescription& robot) {
  return std::any_of(robot.wheels.begin(), robot.wheels.end(),
                     [](const WheelGeometry& wheel) { return !wheel.steering_joint && wheel.drive_joint; });
}

/// Returns the wheels that are not steered; if a motor drives any of them, the driven ones.
std::vector<WheelGeometry> fixed_wheels(const RobotDescription& robot) {
  const bool needs_motor = is_any_driven(robot);
  std::vector<WheelGeometry> wheels;
  for (const WheelGeometry& wheel : robot.wheels) {
    if (wheel.steering_joint || wheel.is_caster) continue;
    if (wheel.drive_joint || !needs_motor) wheels.push_back(wheel);
  }
  return wheels;
}

/// Returns the yaw rate whose steering angles are within the limits of the joints, at this forward speed.
double within_steering_limits(const RobotDescription& robot, double forward_mps, double yaw_rate_radps,
                              double turn_center_x_m) {
  double allowed = std::abs(yaw_rate_radps);
  for (const WheelGeometry& wheel : robot.wheels) {
    if (!wheel.steering_joint) continue;
    const JointLimit& limit = robot.joint_limits[*wheel.steering_joint];
    const double lever_m = wheel.center_in_body.x() - turn_center_x_m;
    const bool is_to_left = (yaw_rate_radps > 0.0) == (forward_mps > 0.0);
    const bool is_positive = (is_to_left == (lever_m > 0.0)) == (wheel.left_sign > 0.0);
    const double max_angle = is_positive ? limit.upper_rad : -limit.lower_rad;
    if (max_angle >= 0.5 * std::numbers::pi) continue;
    // tan(angle) = w lever / (v - w y), with w of the sign of the turn.
    const double tangent = std::tan(std::max(0.0, max_angle));
    const double y_m = is_to_left ? wheel.center_in_body.y() : -wheel.center_in_body.y();
    const double reach_m = std::abs(lever_m) + tangent * y_m;
    if (reach_m > 0.0) allowed = std::min(allowed, std::abs(forward_mps) * tangent / reach_m);
  }
  return std::copysign(allowed, yaw_rate_radps);
}

/// Contact with the ground.
struct Contact {
  double x_m = 0.0;   ///< longitudinal position relative to the middle of the wheels or tracks
  double load = 1.0;  ///< load relative to the mean
};

/// Returns the contacts of a robot without rollers. Loads are those of equal springs under the center of mass.
std::vector<Contact> contacts_of(const RobotDescription& robot, const DifferentialGeometry& geometry) {
  std::vector<Contact> contacts;
  if (robot.tracks) {
    constexpr int kNumContacts = 20;
    for (int i = 0; i < kNumContacts; ++i)
      contacts.push_back({.x_m = ((i + 0.5) / kNumContacts - 0.5) * geometry.contact_length_m});
    return contacts;
  }
  for (const WheelGeometry& wheel : fixed_wheels(robot))
    contacts.push_back({.x_m = wheel.center_in_body.x() - geometry.middle_x_m});
  if (!robot.center_of_mass_x_m) return contacts;
  double variance_m2 = 0.0;
  for (const Contact& contact : contacts)
    variance_m2 += contact.x_m * contact.x_m / static_cast<double>(contacts.size());
  const double offset_m = *robot.center_of_mass_x_m - geometry.middle_x_m;
  for (Contact& contact : contacts) contact.load = std::max(0.0, 1.0 + contact.x_m * offset_m / variance_m2);
  return contacts;
}

/// Returns the root of a function that increases, between two arguments.
template <typename Function>
double root_between(double low, double high, const Function& function) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > 0.0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// Returns the speed of the rim of a mecanum wheel per velocity of the body origin: forward, left, yaw. The rim and the
/// ground have the same velocity along the axis of the roller.
Eigen::RowVector3d rim_speed_row(const WheelGeometry& wheel) {
  const double slope = std::tan(wheel.roller_axis_rad.value());
  return {1.0, slope, slope * wheel.center_in_body.x() - wheel.center_in_body.y()};
}

/// Returns the rows of the wheels, [wheel].
Eigen::MatrixX3d rim_speed_rows(const RobotDescription& robot) {
  Eigen::MatrixX3d rows(robot.wheels.size(), 3);
  for (std::size_t i = 0; i < robot.wheels.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = rim_speed_row(robot.wheels[i]);
  return rows;
}

/// Returns the ratio of the mean lever of the wheels to half of the gauge.
double mecanum_gauge_ratio(const RobotDescription& robot) {
  double lever_m = 0.0;
  for (const WheelGeometry& wheel : robot.wheels) lever_m += (wheel.is_left() ? -1.0 : 1.0) * rim_speed_row(wheel).z();
  lever_m /= static_cast<double>(robot.wheels.size());
  return lever_m / (0.5 * differential_geometry(robot).gauge_m);
}

/// Throws InputError unless the wheels determine the yaw rate: with the pattern O on a square, none has a lever.
void check_levers(const RobotDescription& robot) {
  Eigen::MatrixX3d rows = rim_speed_rows(robot);
  double reach_m = 0.0;
  for (const WheelGeometry& wheel : robot.wheels) reach_m = std::max(reach_m, wheel.center_in_body.head<2>().norm());
  rows.col(2) /= reach_m;
  constexpr double kMinRatio = 0.05;
  const Eigen::Vector3d squares =
      symmetric_eigen(Eigen::Matrix3d(rows.transpose() * rows)).values;  // of the singular values
  if (squares[0] >= kMinRatio * kMinRatio * squares[2]) return;
  throw InputError(
      fmt::format("robot {}: the mecanum wheels do not turn it: their rollers point at its middle", robot.name));
}

WheelCommand mecanum_command(const RobotDescription& robot, const Eigen::Vector3d& velocity) {
  WheelCommand command{.speed_radps = std::vector<double>(robot.joint_names.size(), 0.0),
                       .angle_rad = std::vector<double>(robot.joint_names.size(), 0.0)};
  for (const WheelGeometry& wheel : robot.wheels)
    command.speed_radps[*wheel.drive_joint] = wheel.forward_sign * rim_speed_row(wheel).dot(velocity) / wheel.radius_m;
  return command;
}

}  // namespace

bool has_rollers(const RobotDescription& robot) {
  return std::any_of(robot.wheels.begin(), robot.wheels.end(),
                     [](const WheelGeometry& wheel) { return wheel.roller_axis_rad.has_value(); });
}

void add_rollers(RollerPattern pattern, double angle_rad, RobotDescription& robot) {
  const auto fail = [&robot](const std::string& what) {
    throw InputError(fmt::format("robot {}: mecanum wheels: {}", robot.name, what));
  };
  if (robot.wheels.size() != 4) fail(fmt::format("{} wheels: must be four", robot.wheels.size()));
  double middle_x_m = 0.0;
  for (const WheelGeometry& wheel : robot.wheels) {
    if (wheel.steering_joint) fail(fmt::format("wheel {} is steered: must not be steered", wheel.link));
    if (!wheel.drive_joint) fail(fmt::format("wheel {} has no motor: all four must be driven", wheel.link));
    middle_x_m += 0.25 * wheel.center_in_body.x();
  }
  int num_front_left = 0, num_front_right = 0, num_left = 0;
  for (WheelGeometry& wheel : robot.wheels) {
    const bool is_front = wheel.center_in_body.x() > middle_x_m;
    num_left += wheel.is_left() ? 1 : 0;
    if (is_front) ++(wheel.is_left() ? num_front_left : num_front_right);
    const bool is_to_right = (is_front == wheel.is_left()) == (pattern == RollerPattern::kX);
    wheel.roller_axis_rad = (is_to_right ? -1.0 : 1.0) * (0.5 * std::numbers::pi - angle_rad);
  }
  if (num_left != 2 || num_front_left != 1 || num_front_right != 1)
    fail("each side must have a front and a rear wheel");
  check_levers(robot);
}

WheelDriveType wheel_drive_type(const RobotDescription& robot) {
  bool is_left_driven = false, is_right_driven = false, is_steered = false;
  for (const WheelGeometry& wheel : robot.wheels) {
    if (wheel.drive_joint) (wheel.is_left() ? is_left_driven : is_right_driven) = true;
    is_steered = is_steered || wheel.steering_joint;
  }
  if (!is_left_driven || !is_right_driven)
    throw InputError(fmt::format("robot {}: has no driven wheels on both sides", robot.name));
  if (has_rollers(robot)) return WheelDriveType::kMecanum;
  return is_steered ? WheelDriveType::kAckermann : WheelDriveType::kDifferential;
}

DifferentialGeometry differential_geometry(const RobotDescription& robot) {
  if (robot.tracks) {
    return {.gauge_m = robot.tracks->gauge_m,
            .contact_length_m = robot.tracks->contact_length_m,
            .rolling_radius_m = robot.tracks->sprocket_radius_m};
  }
  const std::vector<WheelGeometry> wheels = fixed_wheels(robot);
  double left_y = 0.0, right_y = 0.0, radius = 0.0, x = 0.0, num_left = 0.0;
  double front = -std::numeric_limits<double>::infinity(), rear = -front;
  for (const WheelGeometry& wheel : wheels) {
    (wheel.is_left() ? left_y : right_y) += wheel.center_in_body.y();
    num_left += wheel.is_left() ? 1.0 : 0.0;
    radius += wheel.radius_m;
    x += wheel.center_in_body.x();
    front = std::max(front, wheel.center_in_body.x());
    rear = std::min(rear, wheel.center_in_body.x());
  }
  const auto count = static_cast<double>(wheels.size());
  if (num_left == 0.0 || num_left == count)
    throw InputError(
        fmt::format("robot {}: has neither tracks nor wheels on both sides that are not steered", robot.name));
  return {.gauge_m = left_y / num_left - right_y / (count - num_left),
          .contact_length_m = front - rear,
          .rolling_radius_m = radius / count,
          .middle_x_m = has_rollers(robot) ? 0.0 : x / count};
}

namespace {

// With the sides at -+u and the robot at yaw rate w about x = c, contact i of the right side slides over the ground at
// (w B/2 - u, w (x_i - c)). With k = (u - w B/2) / w and the loads N_i, friction along the opposite direction gives
// neither a lateral force nor a moment if
//   sum_i N_i (x_i - c) / sqrt(k^2 + (x_i - c)^2) = 0  and
//   sum_i N_i (B/2 k - x_i (x_i - c)) / sqrt(k^2 + (x_i - c)^2) = 0.
SkidTurn turn_on(const std::vector<Contact>& contacts, bool is_symmetric, const DifferentialGeometry& geometry) {
  SkidTurn turn{.turn_center_x_m = geometry.middle_x_m};
  const double half_gauge_m = 0.5 * geometry.gauge_m, half_length_m = 0.5 * geometry.contact_length_m;
  const auto center_at = [&](double k) {
    if (is_symmetric) return 0.0;
    return root_between(-half_length_m, half_length_m, [&](double center) {
      double force = 0.0;
      for (const Contact& contact : contacts)
        force += contact.load * (center - contact.x_m) / std::hypot(k, center - contact.x_m);
      return force;
    });
  };
  const double max_k = 0.5 * geometry.contact_length_m * geometry.contact_length_m / geometry.gauge_m + 1e-9;
  const auto moment_at = [&](double k) {
    const double center = center_at(k);
    double moment = 0.0;
    for (const Contact& contact : contacts) {
      const double arm_m = contact.x_m - center;
      moment += contact.load * (half_gauge_m * k - contact.x_m * arm_m) / std::hypot(k, arm_m);
    }
    return moment;
  };
  const double k = root_between(1e-9, max_k, moment_at);
  turn.gauge_ratio = (half_gauge_m + k) / half_gauge_m;
  turn.turn_center_x_m += center_at(k);
  return turn;
}

}  // namespace

SkidTurn skid_turn(const RobotDescription& robot) {
  const DifferentialGeometry geometry = differential_geometry(robot);
  if (has_rollers(robot)) return {.gauge_ratio = mecanum_gauge_ratio(robot), .turn_center_x_m = geometry.middle_x_m};
  if (geometry.contact_length_m < kPoint_m) return {.turn_center_x_m = geometry.middle_x_m};
  return turn_on(contacts_of(robot, geometry), robot.tracks || !robot.center_of_mass_x_m, geometry);
}

// Equal springs under a rigid chassis: with the relative radii 1 + e_i and the deflection d of the mean load, relative
// to the radius, the load of wheel i changes by (e_i - p_i) / d, where p is the plane of least squares through e over
// the positions of the wheels.
double skid_ratio_std(const RobotDescription& robot, double radius_std, double tire_deflection_ratio) {
  const std::vector<WheelGeometry> wheels = robot.tracks ? std::vector<WheelGeometry>{} : fixed_wheels(robot);
  const DifferentialGeometry geometry = differential_geometry(robot);
  const bool is_rigid = wheels.size() > 4 && !has_rollers(robot) && geometry.contact_length_m >= kPoint_m;
  if (!is_rigid || tire_deflection_ratio <= 0.0) return 0.0;
  Eigen::MatrixX3d positions(wheels.size(), 3);
  for (std::size_t i = 0; i < wheels.size(); ++i)
    positions.row(static_cast<Eigen::Index>(i)) << 1.0, wheels[i].center_in_body.x(), wheels[i].center_in_body.y();
  const auto fit = positions.completeOrthogonalDecomposition();
  const std::vector<Contact> nominal = contacts_of(robot, geometry);
  constexpr double kLoadStep = 1e-3;
  const auto ratio_with = [&](std::size_t wheel, double step) {
    Eigen::VectorXd error = Eigen::VectorXd::Zero(positions.rows());
    error[static_cast<Eigen::Index>(wheel)] = step;
    error -= positions * fit.solve(error).eval();
    std::vector<Contact> contacts = nominal;
    for (std::size_t i = 0; i < contacts.size(); ++i)
      contacts[i].load = std::max(0.0, contacts[i].load + error[static_cast<Eigen::Index>(i)]);
    return turn_on(contacts, false, geometry).gauge_ratio;
  };
  double variance = 0.0;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    const double slope = (ratio_with(i, kLoadStep) - ratio_with(i, -kLoadStep)) / (2.0 * kLoadStep);
    variance += std::pow(slope * radius_std / tire_deflection_ratio, 2);
  }
  return std::sqrt(variance);
}

WheelCommand wheel_command(const RobotDescription& robot, double forward_mps, double yaw_rate_radps,
                           double effective_gauge_ratio, const std::vector<double>& last_angle_rad,
                           double lateral_mps) {
  if (has_rollers(robot)) return mecanum_command(robot, {forward_mps, lateral_mps, yaw_rate_radps});
  const double center_x_m = differential_geometry(robot).middle_x_m;
  const double yaw_rate = wheel_drive_type(robot) == WheelDriveType::kAckermann
                              ? within_steering_limits(robot, forward_mps, yaw_rate_radps, center_x_m)
                              : yaw_rate_radps * effective_gauge_ratio;
  WheelCommand command{.speed_radps = std::vector<double>(robot.joint_names.size(), 0.0),
                       .angle_rad = std::vector<double>(robot.joint_names.size(), 0.0)};
  for (const WheelGeometry& wheel : robot.wheels) {
    double along_mps = forward_mps - yaw_rate * wheel.center_in_body.y();
    if (wheel.steering_joint) {
      const double across_mps = yaw_rate * (wheel.center_in_body.x() - center_x_m);
      const double speed_mps = std::hypot(along_mps, across_mps);
      const double direction = along_mps < 0.0 ? -1.0 : 1.0;
      command.angle_rad[*wheel.steering_joint] =
          speed_mps < kStanding_mps ? last_angle_rad.at(*wheel.steering_joint)
                                    : wheel.left_sign * std::atan2(direction * across_mps, direction * along_mps);
      along_mps = direction * speed_mps;
    }
    if (wheel.drive_joint) command.speed_radps[*wheel.drive_joint] = wheel.forward_sign * along_mps / wheel.radius_m;
  }
  return command;
}

void limit_wheel_speeds(const RobotDescription& robot, std::vector<double>& speed_radps) {
  double scale = 1.0;
  for (std::size_t joint = 0; joint < speed_radps.size(); ++joint)
    scale = std::max(scale, std::abs(speed_radps[joint]) / robot.joint_limits[joint].velocity_radps);
  for (double& speed : speed_radps) speed /= scale;
}

WheelMotion mecanum_motion(const RobotDescription& robot, const std::vector<double>& speed_radps) {
  if (!has_rollers(robot)) throw InputError(fmt::format("robot {}: has no mecanum wheels", robot.name));
  const Eigen::MatrixX3d rows = rim_speed_rows(robot);
  Eigen::VectorXd rim_mps(rows.rows());
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    const WheelGeometry& wheel = robot.wheels[i];
    rim_mps[static_cast<Eigen::Index>(i)] =
        wheel.forward_sign * wheel.radius_m * speed_radps.at(wheel.drive_joint.value());
  }
  WheelMotion motion{.velocity = solve_symmetric(Eigen::Matrix3d(rows.transpose() * rows), rows.transpose() * rim_mps)};
  const Eigen::VectorXd rest_mps = rim_mps - rows * motion.velocity;
  motion.residual_mps = std::copysign(rest_mps.norm() / std::sqrt(static_cast<double>(rows.rows())), rest_mps[0]);
  return motion;
}

double min_turning_radius_m(const RobotDescription& robot) {
  if (wheel_drive_type(robot) != WheelDriveType::kAckermann) return 0.0;
  const double center_x_m = differential_geometry(robot).middle_x_m;
  constexpr double kMore_radps = 1e6;
  const double left = within_steering_limits(robot, 1.0, kMore_radps, center_x_m),
               right = -within_steering_limits(robot, 1.0, -kMore_radps, center_x_m);
  return 1.0 / std::max(1e-9, std::min(left, right));
}

}  // namespace patrol
