#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/atomic_file.h"
#include "io/urdf.h"
#include "io/urdf_reader.h"

namespace patrol::io {
namespace {

std::string attribute_of(const tinyxml2::XMLElement* element, const char* attribute) {
  const char* value = element == nullptr ? nullptr : element->Attribute(attribute);
  return value == nullptr ? "" : value;
}

/// URDF document that is edited mount by mount.
class MountEditor {
 public:
  MountEditor(const std::string& text, const RobotDescription& robot) {
    document_.Parse(text.data(), text.size());  // urdfdom has read it
    fixed_links_.emplace_back(frame_id::kBody);
    for (const auto& [frame, T_body_frame] : robot.T_body_sensor) fixed_links_.push_back(frame);
  }

  void apply(const SensorMount& mount) {
    check(mount);
    tinyxml2::XMLElement* joint = joint_above(mount.frame);
    if (joint == nullptr) joint = add_link(mount.frame);
    child(*joint, "parent").SetAttribute("link", mount.parent.c_str());
    tinyxml2::XMLElement& origin = child(*joint, "origin");
    origin.SetAttribute("xyz", numbers(mount.position_m).c_str());
    origin.SetAttribute("rpy", numbers(mount.rpy_rad).c_str());
  }

  std::string text() const {
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    return printer.CStr();
  }

 private:
  bool is_fixed(const std::string& link) const { return std::ranges::find(fixed_links_, link) != fixed_links_.end(); }

  void check(const SensorMount& mount) const {
    if (!is_fixed(mount.parent)) {
      throw InputError(fmt::format("{}.parent = {}: {}: must be one of {}", mount.location, mount.parent,
                                   has_link(mount.parent) ? "not fixed to base_link" : "unknown link",
                                   join(fixed_links_, ", ")));
    }
    if (has_link(mount.frame) && !is_fixed(mount.frame))
      throw InputError(fmt::format("{}.frame = {}: the link of this name moves: must be fixed to base_link",
                                   mount.location, mount.frame));
    std::string link = mount.parent;
    for (; link != mount.frame; link = attribute_of(joint_above(link)->FirstChildElement("parent"), "link")) {
      if (joint_above(link) == nullptr) return;
    }
    throw InputError(
        fmt::format("{}.parent = {}: is fixed to the frame {} itself", mount.location, mount.parent, mount.frame));
  }

  tinyxml2::XMLElement* joint_above(const std::string& link) const {
    const tinyxml2::XMLElement* joint = document_.RootElement()->FirstChildElement("joint");
    while (joint != nullptr && attribute_of(joint->FirstChildElement("child"), "link") != link)
      joint = joint->NextSiblingElement("joint");
    return const_cast<tinyxml2::XMLElement*>(joint);  // NOLINT(cppcoreguidelines-pro-type-const-cast): of document_
  }

  bool has_link(const std::string& name) const {
    const tinyxml2::XMLElement* link = document_.RootElement()->FirstChildElement("link");
    while (link != nullptr && attribute_of(link, "name") != name) link = link->NextSiblingElement("link");
    return link != nullptr;
  }

  /// Adds a link without mass and shapes, and returns its joint.
  tinyxml2::XMLElement* add_link(const std::string& frame) {
    tinyxml2::XMLElement& root = *document_.RootElement();
    root.InsertNewChildElement("link")->SetAttribute("name", frame.c_str());
    tinyxml2::XMLElement* joint = root.InsertNewChildElement("joint");
    joint->SetAttribute("name", (frame + "_mount").c_str());
    joint->SetAttribute("type", "fixed");
    joint->InsertNewChildElement("child")->SetAttribute("link", frame.c_str());
    fixed_links_.push_back(frame);
    return joint;
  }

  static tinyxml2::XMLElement& child(tinyxml2::XMLElement& joint, const char* name) {
    tinyxml2::XMLElement* element = joint.FirstChildElement(name);
    return element == nullptr ? *joint.InsertNewChildElement(name) : *element;
  }

  static std::string numbers(const Eigen::Vector3d& values) {
    return fmt::format("{} {} {}", values.x(), values.y(), values.z());
  }

  tinyxml2::XMLDocument document_;
  std::vector<std::string> fixed_links_;  ///< the body and the links that are fixed to it
};

}  // namespace

MountedRobot load_mounted_robot(const std::string& path, const std::vector<SensorMount>& mounts) {
  MountedRobot robot{.description = load_robot_description(path), .urdf = load_text(path)};
  if (mounts.empty()) return robot;
  MountEditor editor(robot.urdf, robot.description);
  for (const SensorMount& mount : mounts) editor.apply(mount);
  robot.urdf = editor.text();
  robot.description = UrdfReader(path, robot.urdf).read();
  for (const SensorMount& mount : mounts) {
    if (mount.parent == frame_id::kBody) robot.description.T_body_sensor[mount.frame] = mount.T_parent_frame();
  }
  return robot;
}

}  // namespace patrol::io
