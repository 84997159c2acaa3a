#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/frames.h"

namespace patrol {

/// One three-joint leg (abduction about x, hip about y, knee about y), every length from the URDF.
/// Left legs have positive `abduction_offset_m`.
struct LegGeometry {
  std::string name;                                             ///< "FL", "FR", "RL", "RR"
  Eigen::Vector3d hip_in_body = Eigen::Vector3d::Zero();  ///< abduction axis, m, in body
  double abduction_offset_m = 0.0;                              ///< from abduction axis to thigh along y
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

/// A pair of tracks, driven by a sprocket each.
struct TrackGeometry {
  double gauge_m = 0.0;            ///< between the middles of the two tracks
  double width_m = 0.0;            ///< of one track
  double contact_length_m = 0.0;   ///< between the axles of the outermost road wheels
  double sprocket_radius_m = 0.0;  ///< of the belt's pitch line: the belt runs at this times the sprocket's rate
  double body_height_m = 0.0;      ///< of the body's origin above level ground under the belts
};

/// Turns the coil of the water detector: a yaw joint (to the left) and on it a pitch joint (downwards), whose axes meet in the coil's middle.
struct AntennaGeometry {
  Pose3 T_body_mount;  ///< there; the coil's axis is x of it at yaw 0 and pitch 0
  JointLimit yaw, pitch;
  double stowed_yaw_rad = 0.0;
  double stowed_pitch_rad = -std::numbers::pi / 2.0;  ///< the loop lies flat

  Pose3 T_body_tem(double yaw_rad, double pitch_rad) const {
    return T_body_mount * Pose3{Eigen::Vector3d::Zero(), quaternion_from_rpy(0.0, pitch_rad, yaw_rad)};
  }
};

/// What the robot knows of itself, read from its URDF (io/urdf.h).
struct RobotDescription {
  std::string name;
  double mass_kg = 0.0;
  std::vector<LegGeometry> legs;          ///< FL, FR, RL, RR; empty for a robot without legs
  std::optional<TrackGeometry> tracks;    ///< of a tracked robot
  std::optional<AntennaGeometry> antenna;    ///< of a robot with a link `tem_mount`
  std::vector<std::string> joint_names;   ///< leg by leg: abduction, hip, knee; or the sprockets: left, right
  std::vector<JointLimit> joint_limits;   ///< [joint]
  std::vector<Eigen::Vector2d> footprint_m;    ///< convex hull of the collision shapes in level, counter-clockwise
  /// Fixed frames: "lidar", "lidar3d", "imu", "tdlas", "gnss", "uwb", "scanner", "tem_mount", "depth_camera", "ultrasonic_0", "ultrasonic_1" ...
  std::map<std::string, Pose3> T_body_sensor;

  /// Of the circle about the body's origin that holds the outline.
  double outline_radius_m() const {
    double radius_m = 0.0;
    for (const Eigen::Vector2d& corner : footprint_m) radius_m = std::max(radius_m, corner.norm());
    return radius_m;
  }

  /// Throws InputError when the robot has no such frame.
  const Pose3& T_body(const std::string& sensor) const {
    const auto frame = T_body_sensor.find(sensor);
    if (frame == T_body_sensor.end()) throw InputError("robot " + name + ": there is no link named " + sensor);
    return frame->second;
  }
};

}  // namespace patrol
