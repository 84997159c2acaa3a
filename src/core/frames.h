#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

/// Coordinate frames and rigid transforms.
///
///   world     ground-truth frame of the simulator; z up; unknown to the stack
///   map       frame of the SLAM map; origin at the initial `level` pose; may jump on a loop closure
///   odom      continuous odometry frame; drifts and never jumps
///   body      base of the robot (REP 105 `base_link`); x forward, y left, z up (REP 103)
///   level     gravity-aligned body frame: no roll or pitch, same origin (REP 105 `base_footprint` at trunk height)
///   <sensor>  `lidar`, `imu`, ...
///
/// `T_a_b` maps coordinates in b to coordinates in a: p_a = T_a_b * p_b. Neighboring names meet in products:
/// T_world_map * T_map_body. Angles are in radians, lengths in meters.
namespace patrol {

/// Frame names in messages and files (REP 105).
namespace frame_id {
inline constexpr const char* kMap = "map";
inline constexpr const char* kOdom = "odom";
inline constexpr const char* kBody = "base_link";
inline constexpr const char* kLevel = "base_footprint";
inline constexpr const char* kWorld = "world";
}  // namespace frame_id

/// Returns the equivalent angle in (-pi, pi].
inline double wrap_angle(double angle_rad) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  // Fast path for sums and differences of wrapped angles. Subtracting one full turn is exact (Sterbenz lemma), so the
  // result is bit-identical to that of std::remainder.
  if (std::abs(angle_rad) < 9.0) {
    if (angle_rad > std::numbers::pi) return angle_rad - kTurn;
    return angle_rad <= -std::numbers::pi ? angle_rad + kTurn : angle_rad;
  }
  const double wrapped = std::remainder(angle_rad, kTurn);
  return wrapped <= -std::numbers::pi ? wrapped + kTurn : wrapped;
}

/// Pose in the plane.
struct Pose2 {
  double x = 0.0;    ///< m
  double y = 0.0;    ///< m
  double yaw = 0.0;  ///< rad, counterclockwise

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

/// Pose in space.
struct Pose3 {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();            ///< m
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit quaternion

  Pose3 inverse() const { return {rotation.conjugate() * Eigen::Vector3d(-position), rotation.conjugate()}; }

  friend Pose3 operator*(const Pose3& T_a_b, const Pose3& T_b_c) {
    return {T_a_b.position + T_a_b.rotation * T_b_c.position, T_a_b.rotation * T_b_c.rotation};
  }
  friend Eigen::Vector3d operator*(const Pose3& T_a_b, const Eigen::Vector3d& p_b) {
    return T_a_b.position + T_a_b.rotation * p_b;
  }
};

/// Returns the yaw angle of a rotation Rz(yaw) Ry(pitch) Rx(roll), rad.
inline double to_yaw(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

inline Eigen::Quaterniond quaternion_from_yaw(double yaw_rad) {
  return {std::cos(yaw_rad / 2.0), 0.0, 0.0, std::sin(yaw_rad / 2.0)};
}

/// Returns the rotation Rz(yaw) Ry(pitch) Rx(roll), the convention of URDF and REP 103.
Eigen::Quaterniond quaternion_from_rpy(double roll_rad, double pitch_rad, double yaw_rad);

/// Projects a pose onto the ground plane: keeps x, y and yaw.
inline Pose2 to_pose2(const Pose3& T_a_b) { return {T_a_b.position.x(), T_a_b.position.y(), to_yaw(T_a_b.rotation)}; }

inline Pose3 to_pose3(const Pose2& T_a_b, double z_m = 0.0) {
  return {{T_a_b.x, T_a_b.y, z_m}, quaternion_from_yaw(T_a_b.yaw)};
}

/// Returns the pose with roll and pitch removed; position and yaw are unchanged.
inline Pose3 remove_tilt(const Pose3& T_a_b) { return {T_a_b.position, quaternion_from_yaw(to_yaw(T_a_b.rotation))}; }

/// Interpolates linearly in position and spherically in rotation. Fraction 0 gives a, fraction 1 gives b.
Pose3 interpolate(const Pose3& a, const Pose3& b, double fraction);

/// Velocity of the body relative to the world, expressed in the body frame.
struct Twist3 {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< rad/s
};

}  // namespace patrol
