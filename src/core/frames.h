#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

/// The frames, and the poses between them.
///
///   world     the simulator's truth; z up; nobody in the stack can name it
///   map       what SLAM builds; origin is the level body pose at the start; may jump on a loop closure
///   odom      smooth and drifting; never jumps
///   body      the robot's base (REP 105 `base_link`); x forward, y left, z up (REP 103)
///   level     the body with roll and pitch removed, at the same origin (REP 105 `base_footprint`, kept at trunk height)
///   <sensor>  `lidar`, `imu`, ...
///
/// `T_a_b` takes coordinates in b to coordinates in a: p_a = T_a_b * p_b, and neighbouring names meet:
/// T_world_map * T_map_body. Angles are radians, lengths metres.
namespace patrol {

/// Names in messages and files (REP 105).
namespace frame_id {
inline constexpr const char* kMap = "map";
inline constexpr const char* kOdom = "odom";
inline constexpr const char* kBody = "base_link";
inline constexpr const char* kLevel = "base_footprint";
inline constexpr const char* kWorld = "world";
}  // namespace frame_id

/// The angle's representative in (-pi, pi].
inline double wrap_angle(double angle_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  // Sums and differences of wrapped angles, to the bit what the slow remainder gives: one turn is taken off without rounding (Sterbenz).
  if (std::abs(angle_rad) < 9.0) {
    if (angle_rad > std::numbers::pi) return angle_rad - kTurn;
    return angle_rad <= -std::numbers::pi ? angle_rad + kTurn : angle_rad;
  }
  const double wrapped = std::remainder(angle_rad, kTurn);
  return wrapped <= -std::numbers::pi ? wrapped + kTurn : wrapped;
}

/// A pose in the plane.
struct Pose2 {
  double x = 0.0;    ///< m
  double y = 0.0;    ///< m
  double yaw = 0.0;  ///< rad, counter-clockwise

  Eigen::Vector2d position() const { return {x, y}; }
  Eigen::Vector3d vector() const { return {x, y, yaw}; }

  Pose2 inverse() const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {-c * x - s * y, s * x - c * y, wrap_angle(-yaw)};
  }

  friend Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
    const double c = std::cos(T_a_b.yaw), s = std::sin(T_a_b.yaw);
    return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y,
            wrap_angle(T_a_b.yaw + T_b_c.yaw)};
  }

  friend Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& p_b) {
    const double c = std::cos(T_a_b.yaw), s = std::sin(T_a_b.yaw);
    return {T_a_b.x + c * p_b.x() - s * p_b.y(), T_a_b.y + s * p_b.x() + c * p_b.y()};
  }
};

/// A pose in space.
struct Pose3 {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit

  Pose3 inverse() const { return {rotation.conjugate() * -position, rotation.conjugate()}; }

  friend Pose3 operator*(const Pose3& T_a_b, const Pose3& T_b_c) {
    return {T_a_b.position + T_a_b.rotation * T_b_c.position, T_a_b.rotation * T_b_c.rotation};
  }
  friend Eigen::Vector3d operator*(const Pose3& T_a_b, const Eigen::Vector3d& p_b) {
    return T_a_b.position + T_a_b.rotation * p_b;
  }
};

/// Heading of a rotation: the yaw of Rz(yaw) Ry(pitch) Rx(roll).
inline double yaw_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

inline Eigen::Quaterniond quaternion_from_yaw(double yaw_rad) {
  return {std::cos(yaw_rad / 2.0), 0.0, 0.0, std::sin(yaw_rad / 2.0)};
}

/// Rz(yaw) Ry(pitch) Rx(roll), the convention of URDF and of REP 103.
inline Eigen::Quaterniond quaternion_from_rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
}

/// The pose's shadow on the ground plane.
inline Pose2 to_planar(const Pose3& T_a_b) {
  return {T_a_b.position.x(), T_a_b.position.y(), yaw_of(T_a_b.rotation)};
}

inline Pose3 to_spatial(const Pose2& T_a_b, double z_m = 0.0) {
  return {{T_a_b.x, T_a_b.y, z_m}, quaternion_from_yaw(T_a_b.yaw)};
}

/// The same place and heading without roll and pitch.
inline Pose3 held_level(const Pose3& T_a_b) { return {T_a_b.position, quaternion_from_yaw(yaw_of(T_a_b.rotation))}; }

/// Linear in position, spherical in rotation; fraction 0 gives a, 1 gives b.
inline Pose3 interpolate(const Pose3& a, const Pose3& b, double fraction) {
  return {a.position + fraction * (b.position - a.position), a.rotation.slerp(fraction, b.rotation)};
}

/// Velocity of the body, expressed in the body.
struct Twist3 {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s
};

}  // namespace patrol
