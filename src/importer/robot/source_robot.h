#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "importer/assumptions.h"
#include "importer/mesh.h"
#include "importer/packages.h"

namespace patrol::importer {
enum class ShapeType { kBox, kCylinder, kSphere, kMesh };

/// Shape of a link. A cylinder's axis is z.
struct Shape {
  ShapeType type = ShapeType::kBox;
  Pose3 T_link_shape = {};
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();        ///< box
  double radius_m = 0.0;                                   ///< cylinder, sphere
  double length_m = 0.0;                                   ///< cylinder
  std::shared_ptr<const std::vector<MeshPart>> mesh = {};  ///< parts by color, scaled to meters
  std::string mesh_name = {};                              ///< stem of the mesh's file
  std::optional<Eigen::Vector4d> rgba = {};                ///< color of the description
  int line = 0;
};

/// Returns all triangles of a mesh shape in the frame of the shape.
Mesh whole_mesh(const Shape& shape);

/// Returns points whose convex hull is that of the shape, in the frame of its link. Circles have 48 corners outside.
std::vector<Eigen::Vector3d> outline(const Shape& shape);

/// Returns volume, center and inertia of a shape of density 1, in the frame of its link. Meshes that are not closed are
/// replaced by their convex hull.
SolidProperties solid_of(const Shape& shape);

/// Mass and inertia of a link.
struct SourceInertial {
  double mass_kg = 0.0;
  Pose3 T_link_inertia = {};
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg m^2, about the center of mass, along T_link_inertia
  int line = 0;
};

struct SourceLink {
  std::string name;
  int line = 0;
  std::optional<SourceInertial> inertial = {};
  std::vector<Shape> visuals = {};
  std::vector<Shape> collisions = {};

  bool has_shapes() const { return !visuals.empty() || !collisions.empty(); }
};

enum class JointType { kFixed, kContinuous, kRevolute, kPrismatic, kFloating, kPlanar };

struct SourceJoint {
  std::string name;
  int line = 0;
  JointType type = JointType::kFixed;
  std::string parent = {};
  std::string child = {};
  Pose3 T_parent_child = {};
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< unit vector in the child
  double lower = 0.0, upper = 0.0;
  std::optional<double> effort = {}, velocity = {};
  double damping = 0.0, friction = 0.0;
  bool is_mimic = false;
  std::string mimicked = {};  ///< joint that <mimic> follows
  int mimic_line = 0;

  /// Whether the joint turns without end: continuous, or at least two full turns.
  bool is_endless() const;
  /// Returns lower and upper limit of a steering joint; none if it turns without end. Those of a continuous joint
  /// count, although its type has none, if they are at most a quarter turn to either side.
  std::optional<std::pair<double, double>> steering_limits() const;
};

/// Numbers that the description states of a lidar, by the key of LidarSettings (core/sensors/lidar.h).
using LidarNumbers = std::map<std::string, double>;

/// Sensor of the description.
struct SourceSensor {
  std::string frame = {};  ///< sensor frame of Patrol: lidar, lidar3d, imu, gnss, depth_camera
  std::string link = {};
  Pose3 T_link_sensor = {};
  int line = 0;
  LidarNumbers stated = {};  ///< lidars only
};

/// Vendor's robot description as written: a tree of links and joints.
struct SourceRobot {
  std::string file;  ///< name of the file in messages
  std::string name;
  std::map<int, std::string> positions = {};  ///< lines of an expanded xacro file to "FILE:LINE" in its xacro file
  std::vector<SourceLink> links;
  std::vector<SourceJoint> joints;
  std::set<std::string> motors;  ///< joints named by a transmission, a command interface or a drive plugin
  std::vector<SourceSensor> sensors;
  std::map<std::string, std::pair<double, double>> frictions = {};  ///< link to mu1 and mu2 of Gazebo
  std::vector<Assumption> assumptions;                              ///< made by the reader

  /// Positions of links and joints by name, extended by the functions below. Names of added ones must not change.
  struct Index {
    std::size_t num_links = 0, num_joints = 0;
    std::unordered_map<std::string, std::size_t> link, joint, joint_above;
    std::unordered_map<std::string, std::vector<std::size_t>> joints_below;
  };
  mutable Index index = {};

  const SourceLink* find_link(const std::string& link_name) const;
  const SourceLink& link(const std::string& link_name) const;
  const SourceJoint* parent_joint(const std::string& link_name) const;  ///< null for the root
  std::vector<const SourceJoint*> child_joints(const std::string& link_name) const;
  const SourceLink& root() const;
  const SourceJoint* find_joint(const std::string& joint_name) const;

  /// Whether a joint moves the whole robot in the world, as planners need it: the links that it does not move have no
  /// shapes and at most 1 % of the mass. Above a floating joint they may have visuals, which mark the world.
  bool moves_whole_robot(const SourceJoint& joint) const;

  /// Returns "FILE:LINE" for messages; of an expanded xacro file in the xacro file that has the element.
  std::string location(int line) const;
  /// Returns "line LINE" for texts about the file; of an expanded xacro file "NAME:LINE" without the folder.
  std::string short_location(int line) const;

  [[noreturn]] void fail(int line, const std::string& element, const std::string& what) const;

 private:
  void extend_index() const;
};

/// Parses a URDF text and loads its meshes. Throws InputError with "file:line: element: what" for a description that is
/// not a tree of links with physical masses.
SourceRobot read_source_robot(const std::string& file, const std::string& text, const Packages& packages);

}  // namespace patrol::importer
