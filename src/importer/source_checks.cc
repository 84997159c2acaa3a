#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/linear_algebra.h"
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

/// Checks masses and inertias of links below movable joints.
void SourceReader::check_joints() const {
  for (const SourceJoint& joint : robot_.joints) {
    if (joint.type == JointType::kFixed) continue;
    const SourceLink& child = robot_.link(joint.child);
    if (child.inertial && child.inertial->mass_kg <= 0.0)
      robot_.fail(child.inertial->line, child.name, "mass = 0: must be positive for a moving link");
  }
  for (const SourceLink& link : robot_.links) {
    if (!link.inertial || link.inertial->mass_kg <= 0.0) continue;
    const Eigen::Vector3d moments = symmetric_eigen(link.inertial->inertia).values;
    const bool is_physical =
        moments[0] >= -1e-2 * moments[2] && moments[2] >= 0.0 && moments[2] <= 1.01 * (moments[0] + moments[1]);
    if (!is_physical && moments.cwiseAbs().maxCoeff() > 1e-12) {
      robot_.fail(
          link.inertial->line, link.name,
          fmt::format("invalid inertia: principal moments {:.3g}, {:.3g} and {:.3g} kg m2: the largest must not "
                      "exceed the sum of the others",
                      moments[0], moments[1], moments[2]));
    }
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
