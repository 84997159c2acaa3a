#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tinyxml2.h>

#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Reader of the elements of a description.
class SourceReader {
 public:
  /// Throws InputError with file and line if the text is not XML.
  SourceReader(const std::string& file, const std::string& text, const Packages& packages);

  SourceRobot read();

 private:
  [[noreturn]] void fail(const tinyxml2::XMLElement& element, const std::string& name, const std::string& what) const {
    robot_.fail(element.GetLineNum(), name, what);
  }

  std::vector<double> numbers(const tinyxml2::XMLElement& element, const char* attribute, std::size_t count,
                              const std::string& name) const;
  double number(const tinyxml2::XMLElement& element, const char* attribute, const std::string& name) const;
  std::optional<double> optional_number(const tinyxml2::XMLElement& element, const char* attribute,
                                        const std::string& name) const;
  double positive(const tinyxml2::XMLElement& element, const char* attribute, const std::string& name) const;
  Eigen::Vector3d vector(const tinyxml2::XMLElement& element, const char* attribute, const std::string& name) const;
  Pose3 origin(const tinyxml2::XMLElement& parent, const std::string& name) const;
  std::string required_name(const tinyxml2::XMLElement& element) const;
  void read_materials(const tinyxml2::XMLElement& root);
  std::optional<Eigen::Vector4d> read_color(const tinyxml2::XMLElement& material, const std::string& name) const;
  std::optional<Shape> read_shape(const tinyxml2::XMLElement& element, const std::string& link);
  SourceInertial read_inertial(const tinyxml2::XMLElement& element, const std::string& link) const;
  void read_link(const tinyxml2::XMLElement& element);
  void read_joint(const tinyxml2::XMLElement& element);
  JointType joint_type(const tinyxml2::XMLElement& element, const std::string& joint) const;
  void read_axis(const tinyxml2::XMLElement& axis, SourceJoint& joint) const;
  void read_limit(const tinyxml2::XMLElement& limit, bool needs_limit, SourceJoint& joint);
  void read_mimic(const tinyxml2::XMLElement& mimic, SourceJoint& joint) const;
  Eigen::Vector3d read_scale(const tinyxml2::XMLElement& element, const std::string& link);
  void read_mesh(const tinyxml2::XMLElement& element, const std::string& link, Shape& shape);
  void read_motors(const tinyxml2::XMLElement& root);
  void read_command_limits(const tinyxml2::XMLElement& control, const std::string& name);
  void read_plugin(const tinyxml2::XMLElement& plugin);
  void read_friction(const tinyxml2::XMLElement& gazebo, const std::string& link);
  void read_sensors(const tinyxml2::XMLElement& root);
  void read_gazebo_sensor(const tinyxml2::XMLElement& sensor, const std::string& link);
  double number_of(const tinyxml2::XMLElement& element, const char* raw, const std::string& subject,
                   const std::string& name, const char* owner) const;
  std::optional<double> sensor_number(const tinyxml2::XMLElement& element, const char* name,
                                      const std::string& link) const;
  void read_scan(const tinyxml2::XMLElement& sensor, SourceSensor& found);
  void read_field_of_view(const tinyxml2::XMLElement& horizontal, SourceSensor& found);
  void read_rings(const tinyxml2::XMLElement& vertical, SourceSensor& found) const;
  void read_range(const tinyxml2::XMLElement& range, SourceSensor& found);
  void report_unknown_link(const std::string& link, int line, const std::string& override_with);
  void check_tree() const;
  void check_mimics() const;
  void check_inertias();
  void check_missing_visuals();
  bool has_rigid_collision(const std::string& link) const;
  void report_misspelled_elements(const tinyxml2::XMLElement& root);
  void report_meshes_elsewhere();
  void scale_millimeters();
  void check_shape(const Shape& shape, const SourceLink& link) const;
  bool is_of_world(const SourceJoint& joint) const;
  void check_sizes() const;

  /// Visual whose mesh was not found.
  struct MissingVisual {
    std::string link = {};
    int line = 0;
    std::string uri = {};
    std::string message = {};
  };

  const Packages& packages_;
  tinyxml2::XMLDocument document_;
  SourceRobot robot_;
  std::map<std::string, Eigen::Vector4d> materials_;
  std::map<std::string, std::shared_ptr<const std::vector<MeshPart>>> meshes_;  ///< parts of meshes by path and scale
  std::map<std::string, std::string> unscaled_;  ///< key of `meshes_` without scale, to the extension
  std::vector<MissingVisual> missing_visuals_;
  std::map<std::string, int> joint_lines_;                  ///< lines of the joints, by name
  std::map<std::string, std::set<std::string>> elsewhere_;  ///< names of meshes that were searched for, by folder
};

}  // namespace patrol::importer
