#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "importer/source_reader.h"

namespace patrol::importer {
namespace {

constexpr double kMaxRobot_m = 20.0;

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
  for (const SourceLink& link : robot_.links) {
    std::size_t steps = 0;
    for (auto at = joint_of.find(link.name); at != joint_of.end(); at = joint_of.find(at->second->parent)) {
      if (++steps > joint_of.size()) robot_.fail(at->second->line, link.name, "the joints form a cycle");
    }
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

/// Leaves out visuals without their mesh beside a collision shape. Without one, the visual is the contact shape.
void SourceReader::check_missing_visuals() {
  for (const MissingVisual& missing : missing_visuals_) {
    if (!has_rigid_collision(missing.link)) robot_.fail(missing.line, missing.link, missing.message);
    robot_.assumptions.push_back({.subject = missing.link,
                                  .text = fmt::format("is drawn without {}: mesh file not found", missing.uri),
                                  .override_with = "the file, or --package NAME=FOLDER"});
  }
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

void SourceReader::check_sizes() const {
  for (const SourceLink& link : robot_.links) {
    for (const std::vector<Shape>* shapes : {&link.visuals, &link.collisions}) {
      for (const Shape& shape : *shapes) {
        if (shape.type != ShapeType::kMesh) continue;
        const double size_m = diagonal_m(whole_mesh(shape));
        if (size_m <= kMaxRobot_m) continue;
        robot_.fail(shape.line, link.name,
                    fmt::format("mesh {} is {:.0f} m large: at most {} m: check its scale", shape.mesh_name, size_m,
                                kMaxRobot_m));
      }
    }
  }
}

}  // namespace patrol::importer
