#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "importer/robot/name_registry.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Gives the links of the result their names, visuals and collision shapes.
class LinkBuilder {
 public:
  LinkBuilder(const RobotLayout& layout, NormalizedRobot& robot);

  /// Returns the name of a link or a joint of the file in the result.
  std::string link_name(const std::string& source_name);
  std::string joint_name(const std::string& source_name);
  /// Returns the name of a link of the file that has one in the result; none for the base and for merged links.
  std::optional<std::string> added_name(const std::string& source_name) const;
  /// Returns a free name for a link or a joint that the file does not have.
  std::string new_link_name(const std::string& wanted, const std::string& suffix) {
    return used_links_.unique(wanted, suffix);
  }
  std::string new_joint_name(const std::string& wanted, const std::string& suffix) {
    return used_joints_.unique(wanted, suffix);
  }

  void add_visuals(const SourceLink& link, const Pose3& T_new_link, NormalizedLink& target);
  void add_collisions(const SourceLink& link, const Pose3& T_new_link, bool from_visuals, NormalizedLink& target);

 private:
  /// File of a part of a mesh and its color.
  using ColoredFile = std::pair<std::string, std::optional<Eigen::Vector4d>>;

  std::string add_mesh(const std::string& stem, const Mesh& mesh);
  const std::vector<ColoredFile>& files_of(const Shape& visual);
  const std::vector<std::string>& hulls_of(const Shape& shape, const SourceLink& link);

  const RobotLayout& layout_;
  NormalizedRobot& robot_;
  NameRegistry used_links_, used_joints_, used_files_;
  std::map<std::string, std::string> link_names_, joint_names_;  ///< source to result
  std::map<const void*, std::vector<ColoredFile>> mesh_files_;   ///< files by mesh
  std::map<const void*, std::vector<std::string>> hull_files_;   ///< files by mesh
};

}  // namespace patrol::importer
