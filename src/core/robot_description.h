#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol {

/// Joint of a leg with an arbitrary frame.
struct LegJoint {
  Pose3 T_parent_joint;  ///< pose in the frame of the previous joint, of the first joint in body, at angle 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit vector, in the frame of the joint
};

/// Three joints of a leg and its foot.
struct LegChain {
  std::array<LegJoint, 3> joints = {};             ///< from the body to the foot
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();  ///< center of the foot in the frame of the last joint, m
};

/// Geometry of a leg with three joints; all lengths are from the URDF. Left legs have positive `abduction_offset_m`.
///
/// Most legs have their abduction about x, then hip and knee about y, and hang straight down at zero; the lengths here
/// describe them completely. Other legs have a `chain`, and the lengths are those of their standing posture.
struct LegGeometry {
  std::string name;                                       ///< "FL", "FR", "RL", "RR"
  Eigen::Vector3d hip_in_body = Eigen::Vector3d::Zero();  ///< position of the abduction axis in body, m
  double abduction_offset_m = 0.0;                        ///< distance from the abduction axis to the thigh along y
  double thigh_m = 0.0;
  double shank_m = 0.0;
  double foot_radius_m = 0.0;
  std::string foot_link = {};                       ///< link with the sphere of the foot
  Eigen::Vector3d standing_rad = {0.0, 0.8, -1.6};  ///< joint angles of the standing posture
  std::optional<LegChain> chain = std::nullopt;     ///< joints in general position

  double length_m() const { return thigh_m + shank_m; }
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
  /// Direction of the axis of the roller on the ground, from x of body to the left, in (-pi/2, pi/2); none for a wheel
  /// without rollers. Only mecanum wheels have rollers (`add_rollers` in core/wheel_kinematics.h).
  std::optional<double> roller_axis_rad = std::nullopt;

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
  /// Longitudinal position of the center of mass in body with all joints at zero; robots with wheels only. None: in the
  /// middle of the wheels.
  std::optional<double> center_of_mass_x_m;
  std::vector<LegGeometry> legs;  ///< FL, FR, RL, RR; empty for a robot without legs
  /// Center of mass in body and moments of inertia about it, in the standing posture; robots with legs only.
  Eigen::Vector3d standing_center_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d standing_inertia_kgm2 = Eigen::Vector3d::Zero();
  std::optional<TrackGeometry> tracks;     ///< tracked robots only
  std::vector<WheelGeometry> wheels;       ///< wheels on the ground; empty for a robot without wheels
  std::optional<AntennaGeometry> antenna;  ///< robots with a link `tem_mount` only
  /// Leg by leg, from the body to the foot: three joints; for tracked robots the sprockets: left, right; for wheeled
  /// robots the driven wheels and then the steering joints.
  std::vector<std::string> joint_names;
  std::vector<JointLimit> joint_limits;      ///< [joint]
  std::vector<Eigen::Vector2d> footprint_m;  ///< convex hull of the collision shapes in level, counterclockwise
  /// Poses of the fixed frames: "lidar", "lidar_rear", "lidar3d", "imu", "tdlas", "gnss", "uwb", "scanner",
  /// "tem_mount", "depth_camera", "ultrasonic_0", "ultrasonic_1" ...
  std::map<std::string, Pose3> T_body_sensor;

  /// Returns the radius of the circle around the body origin that encloses the footprint.
  double outline_radius_m() const;

  /// Returns the height of the body origin above level ground by the geometry of tracks, wheels, or legs in their
  /// standing posture, m.
  double body_height_m() const;

  /// Returns the pose of a sensor frame in body. Throws InputError if the robot has no such frame.
  const Pose3& T_body(const std::string& sensor) const;
};

}  // namespace patrol
