#pragma once

#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "importer/robot/scan_band.h"
#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Mass and inertia of a link of the result.
struct Inertial {
  double mass_kg = 0.0;
  Pose3 T_link_inertia = {};
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg m^2, about the center of mass, along T_link_inertia
};

/// Visual or collision shape of the result: a primitive, or a mesh file.
struct NormalizedShape {
  Shape shape = {};            ///< primitive, and pose in the link
  std::string mesh_file = {};  ///< "meshes/NAME.obj"; empty for a primitive
  std::optional<Eigen::Vector4d> rgba = {};
};

struct JointRange {
  double lower_rad = 0.0;
  double upper_rad = 0.0;
};

/// Motor limits of a joint.
struct Motor {
  double effort_nm = 0.0;
  double velocity_radps = 0.0;
};

/// Joint of the result: fixed, continuous (no range) or revolute.
struct NormalizedJoint {
  std::string name = {};
  std::string parent = {};
  Pose3 T_parent_link = {};
  bool is_fixed = true;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  std::optional<JointRange> range = {};
  std::optional<Motor> motor = {};
  double damping = 0.0;
  double friction = 0.0;
};

struct NormalizedLink {
  std::string name = {};
  std::optional<NormalizedJoint> joint = {};  ///< none for base_link
  std::optional<Inertial> inertial = {};
  std::vector<NormalizedShape> visuals = {};
  std::vector<NormalizedShape> collisions = {};
};

/// Drive of the result.
enum class DriveType { kDifferential, kAckermann, kMecanum, kLegs };

/// Robot in Patrol's conventions: base_link is the root, wheels roll about y, legs have three joints and a ball as
/// foot, other links are fixed.
struct NormalizedRobot {
  std::string name = {};
  DriveType drive = DriveType::kDifferential;
  std::vector<NormalizedLink> links = {};
  std::vector<std::pair<std::string, std::string>> meshes = {};  ///< file name below meshes/ and OBJ text
  std::vector<std::string> sensor_frames = {};
  std::map<std::string, std::string> lidars = {};  ///< sensor frame to the settings of its lidar; none: defaults
  double max_speed_mps = 0.0;                      ///< maximum speed by the slowest driven wheel
  double length_m = 0.0;                           ///< length of the collision shapes along x
  double keep_out_margin_m = 0.0;                  ///< Ackermann drives; else 0
  double min_turning_radius_m = 0.0;
  double leg_m = 0.0;                      ///< length of the longest leg; robots with legs only
  std::optional<ScanBand> scan_band = {};  ///< none: the defaults suit, or the robot has no 2D lidar
  // Mecanum drives, as the settings of wheel_drive.
  std::string roller_pattern = "x";
  double roller_angle_rad = 0.25 * std::numbers::pi;
  std::vector<Assumption> assumptions = {};
  std::map<std::string, std::string> source_links = {};  ///< link of the result to link of the file
};

/// Returns the combined mass and inertia, in the frame of the first pose's parent.
Inertial combine(const std::vector<std::pair<Pose3, Inertial>>& parts);

/// Returns the text of the URDF file; `comment` is its first line.
std::string to_urdf(const NormalizedRobot& robot, const std::string& comment);

}  // namespace patrol::importer
