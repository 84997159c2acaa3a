#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include "core/error.h"
#include "core/robot_description.h"
#include "io/files/atomic_file.h"

namespace patrol::io {

/// Returns the first line that contains `name` in quotes; 0 if there is none.
inline int line_of(const std::string& text, const std::string& name) {
  const std::size_t at = text.find('"' + name + '"');
  if (at == std::string::npos) return 0;
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

inline Pose3 to_pose(const urdf::Pose& pose) {
  return {{pose.position.x, pose.position.y, pose.position.z},
          Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)};
}

/// Wheel inside the belt of a track: a cylinder across the robot.
struct TrackWheel {
  Eigen::Vector3d center_m;  ///< position in body
  double radius_m;
  double width_m;
};

/// Reader of the elements of one URDF file. Errors contain the line.
class UrdfReader {
 public:
  explicit UrdfReader(const std::string& path) : UrdfReader(path, load_text(path)) {}
  UrdfReader(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {
    check_numbers();
    check_links();
    parse();
    check_tree();
    check_inertias();
  }

  RobotDescription read() const;

 private:
  [[noreturn]] void fail(const std::string& element, const std::string& what) const {
    throw input_error(path_, line_of(text_, element), element + ": " + what);
  }

  void check_numbers() const;
  void check_links() const;
  void parse();
  void check_tree() const;
  void check_inertias() const;
  urdf::JointConstSharedPtr joint(const std::string& name) const;
  Pose3 joint_origin(const std::string& name) const;
  std::vector<urdf::LinkConstSharedPtr> leg_ends() const;
  bool has_legs() const;
  LegGeometry read_chain(const urdf::LinkConstSharedPtr& end) const;
  void choose_standing(const std::array<JointLimit, 3>& limits, double mass_kg, LegGeometry& leg) const;
  void read_legs(RobotDescription& robot) const;
  void check_joints(const RobotDescription& robot) const;
  Pose3 T_body_standing(const urdf::Link& link, const RobotDescription& robot) const;
  void read_standing_inertia(RobotDescription& robot) const;
  std::vector<Eigen::Vector2d> read_legged_footprint(const RobotDescription& robot) const;
  void read_tracks(RobotDescription& robot) const;
  bool has_wheels() const;
  WheelGeometry read_wheel_shape(const urdf::Link& link) const;
  std::size_t add_joint(const std::string& name, RobotDescription& robot) const;
  void read_wheels(RobotDescription& robot) const;
  void check_wheels(const RobotDescription& robot) const;
  std::vector<Eigen::Vector3d> read_vertices(const urdf::Mesh& mesh) const;
  std::vector<Eigen::Vector3d> outline_points(const urdf::Geometry& geometry) const;
  void add_outline(const urdf::Link& link, const Pose3& T_body_link, std::vector<Eigen::Vector2d>& points) const;
  std::vector<Eigen::Vector2d> read_wheeled_footprint() const;
  AntennaGeometry read_antenna() const;
  JointLimit read_limit(const std::string& name) const;
  double sprocket_radius_m(const std::string& link) const;
  std::vector<TrackWheel> read_track_wheels(const std::string& track) const;
  Pose3 T_body_link(const urdf::Link& link) const;
  std::vector<Eigen::Vector2d> read_tracked_footprint() const;

  std::string path_;
  std::string text_;
  urdf::ModelInterfaceSharedPtr model_;
};

}  // namespace patrol::io
