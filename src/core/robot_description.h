#pragma once

#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol {

/// Geometry of a leg with three joints (abduction about x, hip about y, knee about y); all lengths are from the URDF.
/// Left legs have positive `abduction_offset_m`.
struct LegGeometry {
  std::string name;                                       ///< "FL", "FR", "RL", "RR"
  Eigen::Vector3d hip_in_body = Eigen::Vector3d::Zero();  ///< position of the abduction axis in body, m
  double abduction_offset_m = 0.0;                        ///< distance from the abduction axis to the thigh along y
  double thigh_m = 0.0;
  double shank_m = 0.0;
  double foot_radius_m = 0.0;
};

struct JointLimit {
  double lower_rad = 0.0;
  double upper_rad = 0.0;
  double velocity_radps = 0.0;
  double effort_nm = 0.0;
};

/// Geometry of a pair of tracks, each driven by one sprocket.
struct TrackGeometry {
  double gauge_m = 0.0;            ///< distance between the center lines of the two tracks
  double width_m = 0.0;            ///< width of one track
  double contact_length_m = 0.0;   ///< distance between the axles of the outermost road wheels
  double sprocket_radius_m = 0.0;  ///< pitch radius: belt speed over sprocket rate
  double body_height_m = 0.0;      ///< height of the body origin above level ground
};

/// Wheel that rolls about a lateral axis. Its rotation joint is in `RobotDescription::joint_names` if a motor drives
/// it.
struct WheelGeometry {
  std::string link;
  Eigen::Vector3d center_in_body = Eigen::Vector3d::Zero();  ///< m, with the steering joint at zero
  double radius_m = 0.0;
  double width_m = 0.0;
  std::optional<std::size_t> drive_joint = std::nullopt;  ///< index in `joint_names`; none for a wheel without a motor
  std::optional<std::size_t> steering_joint =
      std::nullopt;           ///< index in `joint_names`; none for a wheel that is not steered
  double forward_sign = 1.0;  ///< sign of the joint's rotation when the robot drives forward
  double left_sign = 1.0;     ///< sign of the steering angle when the wheel points to the left
  bool is_caster = false;     ///< the wheel turns freely about a vertical joint

  bool is_left() const { return center_in_body.y() > 0.0; }
};

/// Pan-tilt mount of the TEM coil: a yaw joint (positive to the left) followed by a pitch joint (positive downward).
/// Both axes intersect in the center of the coil.
struct AntennaGeometry {
  Pose3 T_body_mount;  ///< intersection of the joint axes; its x axis is the coil axis at yaw 0 and pitch 0
  JointLimit yaw, pitch;
  double stowed_yaw_rad = 0.0;
  double stowed_pitch_rad = -std::numbers::pi / 2.0;  ///< the plane of the coil is horizontal

  Pose3 T_body_tem(double yaw_rad, double pitch_rad) const {
    return T_body_mount * Pose3{Eigen::Vector3d::Zero(), quaternion_from_rpy(0.0, pitch_rad, yaw_rad)};
  }
};

/// Kinematic and geometric description of a robot, read from its URDF (io/urdf.h).
struct RobotDescription {
  std::string name;
  double mass_kg = 0.0;
  std::vector<LegGeometry> legs;           ///< FL, FR, RL, RR; empty for a robot without legs
  std::optional<TrackGeometry> tracks;     ///< tracked robots only
  std::vector<WheelGeometry> wheels;       ///< wheels on the ground; empty for a robot without wheels
  std::optional<AntennaGeometry> antenna;  ///< robots with a link `tem_mount` only
  /// Leg by leg: abduction, hip, knee; for tracked robots the sprockets: left, right; for wheeled robots the driven
  /// wheels and then the steering joints.
  std::vector<std::string> joint_names;
  std::vector<JointLimit> joint_limits;      ///< [joint]
  std::vector<Eigen::Vector2d> footprint_m;  ///< convex hull of the collision shapes in level, counterclockwise
  /// Poses of the fixed frames: "lidar", "lidar_rear", "lidar3d", "imu", "tdlas", "gnss", "uwb", "scanner",
  /// "tem_mount", "depth_camera", "ultrasonic_0", "ultrasonic_1" ...
  std::map<std::string, Pose3> T_body_sensor;

  /// Returns the radius of the circle around the body origin that encloses the footprint.
  double outline_radius_m() const;

  /// Returns the height of the body origin above level ground by the geometry of tracks or wheels, m; 0 for a robot
  /// with legs.
  double body_height_m() const;

  /// Returns the pose of a sensor frame in body. Throws InputError if the robot has no such frame.
  const Pose3& T_body(const std::string& sensor) const;
};

}  // namespace patrol
