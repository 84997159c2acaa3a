#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "importer/robot/source_reader.h"
#include "importer/xml_elements.h"
#include "io/files/one_line.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::importer {
namespace {

constexpr double kMaxRobot_m = 20.0;
constexpr double kMaxLink_kg = 1e6;

}  // namespace

/// Checks that links and joints are one tree.
void SourceReader::check_tree() const {
  std::map<std::string, const SourceJoint*> joint_of;  // child link to joint
  for (const SourceJoint& joint : robot_.joints) {
    const auto [found, is_new] = joint_of.emplace(joint.child, &joint);
    if (!is_new) {
      robot_.fail(joint.line, joint.child,
                  fmt::format("child of two joints, {} and {}: only one is allowed", found->second->name, joint.name));
    }
  }
  std::set<std::string> rooted;  // links whose joints above form no cycle
  for (const SourceLink& link : robot_.links) {
    std::size_t steps = 0;
    std::vector<std::string> above;
    for (auto at = joint_of.find(link.name); at != joint_of.end() && !rooted.contains(at->first);
         at = joint_of.find(at->second->parent)) {
      above.push_back(at->first);
      if (++steps > joint_of.size()) robot_.fail(at->second->line, link.name, "the joints form a cycle");
    }
    rooted.insert(above.begin(), above.end());
  }
  const SourceLink* root = nullptr;
  for (const SourceLink& link : robot_.links) {
    if (joint_of.contains(link.name)) continue;
    if (root != nullptr)
      robot_.fail(link.line, link.name,
                  fmt::format("is not connected: the robot has two roots, {} and {}", root->name, link.name));
    root = &link;
  }
}

/// Refuses joints that mimic an unknown joint or, by a chain of joints, themselves.
void SourceReader::check_mimics() const {
  for (const SourceJoint& joint : robot_.joints) {
    std::set<const SourceJoint*> followed = {&joint};
    for (const SourceJoint* at = &joint; at->is_mimic;) {
      const SourceJoint* next = robot_.find_joint(at->mimicked);
      if (next == nullptr)
        robot_.fail(at->mimic_line, at->name, fmt::format("<mimic>: unknown joint: {}", io::on_one_line(at->mimicked)));
      if (next == &joint) robot_.fail(joint.mimic_line, joint.name, "<mimic>: the joint follows itself");
      if (!followed.insert(next).second) break;  // refused at a joint of the cycle
      at = next;
    }
  }
}

/// Returns whether a link, or another one that fixed joints connect with it, has a collision shape.
bool SourceReader::has_rigid_collision(const std::string& link) const {
  std::string top = link;
  for (const SourceJoint* joint = robot_.parent_joint(top); joint != nullptr && joint->type == JointType::kFixed;
       joint = robot_.parent_joint(top))
    top = joint->parent;
  std::vector<std::string> open = {top};
  while (!open.empty()) {
    const std::string name = open.back();
    open.pop_back();
    if (!robot_.link(name).collisions.empty()) return true;
    for (const SourceJoint* joint : robot_.child_joints(name)) {
      if (joint->type == JointType::kFixed) open.push_back(joint->child);
    }
  }
  return false;
}

/// Draws links without any of their meshes as their collision shapes. Beside a collision shape of another link, a
/// visual without its mesh is left out. Without one, the visual is the contact shape.
void SourceReader::check_missing_visuals() {
  std::set<std::string> drawn_as_collision;
  for (const MissingVisual& missing : missing_visuals_) {
    if (!has_rigid_collision(missing.link)) robot_.fail(missing.line, missing.link, missing.message);
    const auto link = std::ranges::find(robot_.links, missing.link, &SourceLink::name);
    if (link->visuals.empty() && !link->collisions.empty()) drawn_as_collision.insert(missing.link);
    robot_.assumptions.push_back(
        {.subject = missing.link,
         .text = fmt::format("{} {}: mesh file not found",
                             drawn_as_collision.contains(missing.link) ? "is drawn as its collision shape instead of"
                                                                       : "is drawn without",
                             missing.uri),
         .override_with = "the file, or --package NAME=FOLDER"});
  }
  for (SourceLink& link : robot_.links) {
    if (drawn_as_collision.contains(link.name)) link.visuals = link.collisions;
  }
}

/// Reports elements that are left out and whose names resemble that of an element which is read.
void SourceReader::report_misspelled_elements(const tinyxml2::XMLElement& root) {
  static const std::map<std::string, std::vector<std::string>> kElements = {
      {"robot", {"link", "joint", "material", "gazebo", "transmission"}},
      {"link", {"inertial", "visual", "collision"}},
      {"inertial", {"origin", "mass", "inertia"}},
      {"visual", {"origin", "geometry", "material"}},
      {"collision", {"origin", "geometry"}},
      {"joint", {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"}}};
  const auto check = [this](const tinyxml2::XMLElement& parent) {
    const auto known = kElements.find(parent.Name());
    if (known == kElements.end()) return;
    for (const tinyxml2::XMLElement* child = parent.FirstChildElement(); child; child = child->NextSiblingElement()) {
      const std::string name = child->Name();
      if (std::ranges::find(known->second, name) != known->second.end()) continue;
      const std::string meant = io::closest_match(name, known->second);
      if (meant.empty()) continue;
      robot_.assumptions.push_back(
          {.subject = fmt::format("<{}> in {}", name, robot_.short_location(child->GetLineNum())),
           .text = fmt::format("is left out: unknown element of <{}>", parent.Name()),
           .override_with = fmt::format("<{}>, if it is meant", meant)});
    }
  };
  check(root);
  for_each_below(root, check);
}

/// Reports meshes that are not where the description names them.
void SourceReader::report_meshes_elsewhere() {
  for (const auto& [folder, names] : elsewhere_) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    robot_.assumptions.push_back(
        {.subject = list,
         .text =
             fmt::format("not found where the description names them: the files of these names in {} are used", folder),
         .override_with = "attribute filename of <mesh>, or --package NAME=FOLDER"});
  }
}

/// Scales meshes without a unit by 0.001 if one of their format is larger than 20 m.
void SourceReader::scale_millimeters() {
  std::set<std::string> extensions;  // in millimeters
  std::map<const std::vector<MeshPart>*, std::string> extension_of;
  for (const auto& [key, extension] : unscaled_) {
    const auto& mesh = meshes_.at(key);
    extension_of[mesh.get()] = extension;
    for (const MeshPart& part : *mesh) {
      if (std::max(diagonal_m(part.mesh), max_coordinate_m(part.mesh)) > kMaxRobot_m) extensions.insert(extension);
    }
  }
  if (extensions.empty()) return;
  std::map<const std::vector<MeshPart>*, std::shared_ptr<const std::vector<MeshPart>>> replaced;
  for (SourceLink& link : robot_.links) {
    for (std::vector<Shape>* shapes : {&link.visuals, &link.collisions}) {
      for (Shape& shape : *shapes) {
        const auto found = extension_of.find(shape.mesh.get());
        if (found == extension_of.end() || !extensions.contains(found->second)) continue;
        auto& small = replaced[shape.mesh.get()];
        if (!small) {
          std::vector<MeshPart> parts = *shape.mesh;
          for (MeshPart& part : parts) part.mesh = scaled(part.mesh, Eigen::Vector3d::Constant(1e-3));
          small = std::make_shared<const std::vector<MeshPart>>(std::move(parts));
        }
        shape.mesh = small;
      }
    }
  }
  for (const std::string& extension : extensions) {
    robot_.assumptions.push_back(
        {.subject = fmt::format("meshes *{}", extension),
         .text = "are in millimeters and scaled by 0.001: in meters the robot would be larger than 20 m",
         .override_with = "attribute scale of <mesh>"});
  }
}

/// Refuses a shape that is larger than a robot or farther from its link than a robot is large.
void SourceReader::check_shape(const Shape& shape, const SourceLink& link) const {
  const double distance_m = shape.T_link_shape.position.norm();
  if (distance_m > kMaxRobot_m) {
    robot_.fail(shape.line, link.name,
                fmt::format("<origin> of a shape is {:.3g} m from the link: at most {} m", distance_m, kMaxRobot_m));
  }
  if (shape.type == ShapeType::kMesh) {
    const double size_m = diagonal_m(whole_mesh(shape));
    if (size_m <= kMaxRobot_m) return;
    robot_.fail(
        shape.line, link.name,
        fmt::format("mesh {} is {:.3g} m large: at most {} m: check its scale", shape.mesh_name, size_m, kMaxRobot_m));
  }
  const double size_m = std::max({shape.size_m.maxCoeff(), 2.0 * shape.radius_m, shape.length_m});
  if (size_m > kMaxRobot_m)
    robot_.fail(shape.line, link.name, fmt::format("shape is {:.3g} m large: at most {} m", size_m, kMaxRobot_m));
}

/// Returns whether a joint places the whole robot in the world: its parent is a root without mass and shapes.
bool SourceReader::is_of_world(const SourceJoint& joint) const {
  const SourceLink& parent = robot_.link(joint.parent);
  return robot_.parent_joint(joint.parent) == nullptr && !parent.has_shapes() && !parent.inertial &&
         robot_.child_joints(joint.parent).size() == 1;
}

/// Refuses positions, sizes and masses that no robot has: often lengths in millimeters.
void SourceReader::check_sizes() const {
  for (const SourceLink& link : robot_.links) {
    for (const std::vector<Shape>* shapes : {&link.visuals, &link.collisions}) {
      for (const Shape& shape : *shapes) check_shape(shape, link);
    }
    if (!link.inertial) continue;
    const SourceInertial& inertial = *link.inertial;
    if (inertial.mass_kg > kMaxLink_kg)
      robot_.fail(inertial.line, link.name,
                  fmt::format("mass = {:.3g} kg: at most {:.0f} kg", inertial.mass_kg, kMaxLink_kg));
    const double distance_m = inertial.T_link_inertia.position.norm();
    if (distance_m > kMaxRobot_m)
      robot_.fail(inertial.line, link.name,
                  fmt::format("center of mass is {:.3g} m from the link: at most {} m", distance_m, kMaxRobot_m));
  }
  for (const SourceJoint& joint : robot_.joints) {
    const double distance_m = joint.T_parent_child.position.norm();
    if (distance_m <= kMaxRobot_m || is_of_world(joint)) continue;
    robot_.fail(joint.line, joint.name,
                fmt::format("<origin> is {:.3g} m from the parent link: at most {} m", distance_m, kMaxRobot_m));
  }
}

}  // namespace patrol::importer
