#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/linear_algebra.h"
#include "importer/hull.h"
#include "importer/normalizer.h"

namespace patrol::importer {

std::string Normalizer::add_mesh(const std::string& stem, const Mesh& mesh) {
  const std::string name = unique(used_files_, file_stem(stem), "") + ".obj";
  result_.meshes.emplace_back(name, to_obj(mesh));
  return "meshes/" + name;
}

void Normalizer::add_visuals(const SourceLink& link, const Pose3& T_new_link, NormalizedLink& target) {
  for (const Shape& visual : link.visuals) {
    Shape shape = visual;
    shape.T_link_shape = T_new_link * visual.T_link_shape;
    if (visual.type != ShapeType::kMesh) {
      target.visuals.push_back({.shape = shape, .rgba = visual.rgba});
      continue;
    }
    auto& files = mesh_files_[visual.mesh.get()];
    if (files.empty()) {
      for (const MeshPart& part : *visual.mesh) {
        const std::string file = add_mesh(visual.mesh_name, part.mesh);
        files.emplace_back(file, part.has_color ? std::optional(part.rgba) : std::nullopt);
        if (part.mesh.triangles.size() > kManyTriangles) {
          assume(file,
                 fmt::format("has {} triangles and slows rendering down: at most {} are advised",
                             part.mesh.triangles.size(), kManyTriangles),
                 "<mesh filename> of the visual");
        }
      }
    }
    for (const auto& [file, color] : files)
      target.visuals.push_back({.shape = shape, .mesh_file = file, .rgba = visual.rgba ? visual.rgba : color});
  }
}

void Normalizer::add_collisions(const SourceLink& link, const Pose3& T_new_link, bool from_visuals,
                                NormalizedLink& target) {
  const std::vector<Shape>& shapes = from_visuals ? link.visuals : link.collisions;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!from_visuals && support_shapes_.contains({link.name, i})) continue;
    Shape shape = shapes[i];
    shape.T_link_shape = T_new_link * shape.T_link_shape;
    if (shape.type != ShapeType::kMesh) {
      if (shape.type == ShapeType::kBox && shape.size_m.minCoeff() <= 0.0) continue;
      target.collisions.push_back({.shape = shape});
      continue;
    }
    auto& files = hull_files_[shapes[i].mesh.get()];
    if (files.empty()) {
      const ConvexPieces pieces = convex_pieces(whole_mesh(shape));
      for (const Mesh& piece : pieces.pieces) files.push_back(add_mesh(shape.mesh_name + "_hull", piece));
      if (pieces.pieces.empty())
        source_.fail(
            shape.line, link.name,
            fmt::format("collision mesh {} has no surface: must have triangles with an area", shape.mesh_name));
      assume(
          link.name,
          fmt::format(
              "collision mesh {} is replaced by {} convex piece{}, the hulls of its connected components{}{}",
              shape.mesh_name, pieces.pieces.size(), pieces.pieces.size() == 1 ? "" : "s",
              pieces.num_dropped > 0 ? fmt::format("; {} small or enclosed ones are left out", pieces.num_dropped) : "",
              pieces.num_merged > 0 ? fmt::format("; {} are merged with a neighbor", pieces.num_merged) : ""),
          "<collision> of the link");
    }
    for (const std::string& file : files) target.collisions.push_back({.shape = shape, .mesh_file = file});
  }
}

/// Returns the inertia of solid shapes of one density with a given mass; 0: the density of a link without mass.
Inertial Normalizer::solid_inertial(const std::vector<Shape>& shapes, double mass_kg) const {
  std::vector<std::pair<Pose3, Inertial>> parts;
  double volume_m3 = 0.0;
  for (const Shape& shape : shapes) {
    const SolidProperties solid = solid_of(shape);
    if (solid.volume_m3 <= 0.0) continue;
    volume_m3 += solid.volume_m3;
    parts.push_back(
        {{}, {.mass_kg = solid.volume_m3, .T_link_inertia = translation(solid.center_m), .inertia = solid.inertia}});
  }
  constexpr double kMinMass_kg = 0.01, kMaxMass_kg = 200.0;
  if (parts.empty()) {
    const double mass = mass_kg > 0.0 ? mass_kg : kMinMass_kg;
    return {.mass_kg = mass, .inertia = 0.4 * mass * 0.02 * 0.02 * Eigen::Matrix3d::Identity()};  // sphere of 2 cm
  }
  const double mass = mass_kg > 0.0 ? mass_kg : std::clamp(kDensity_kgpm3 * volume_m3, kMinMass_kg, kMaxMass_kg);
  for (auto& [pose, part] : parts) {
    part.mass_kg *= mass / volume_m3;
    part.inertia *= mass / volume_m3;
  }
  return combine(parts);
}

/// Measures the mass of the file and the box around all shapes.
void Normalizer::measure_box() {
  for (const SourceLink& link : source_.links) {
    source_kg_ += link.inertial ? link.inertial->mass_kg : 0.0;
    for (const std::vector<Shape>* shapes : {&link.collisions, &link.visuals}) {
      for (const Shape& shape : *shapes) {
        for (const Eigen::Vector3d& point : outline(shape)) box_.extend(T_root_link_.at(link.name) * point);
      }
    }
  }
}

/// Refuses a center of mass that is farther from the shapes than the robot is large.
void Normalizer::check_centers() const {
  if (box_.isEmpty()) return;
  const double size_m = box_.diagonal().norm();
  for (const SourceLink& link : source_.links) {
    if (!link.inertial || link.inertial->mass_kg <= 0.0) continue;
    const double outside_m = box_.exteriorDistance(T_root_link_.at(link.name) * link.inertial->T_link_inertia.position);
    if (outside_m <= size_m) continue;
    source_.fail(link.inertial->line, link.name,
                 fmt::format("center of mass is {:.3g} m outside the shapes of a robot of {:.3g} m: check <origin>",
                             outside_m, size_m));
  }
}

/// Returns the inertia of a link, with moments that no body has corrected.
std::optional<Inertial> Normalizer::checked_inertial(const SourceLink& link) {
  if (!link.inertial) return std::nullopt;
  if (link.inertial->mass_kg <= 0.0) {
    assume(link.name, "its <inertial> with mass 0 is left out", "<mass> of the link");
    return std::nullopt;
  }
  Inertial inertial = to_inertial(*link.inertial);
  const std::vector<Shape>& shapes = !link.collisions.empty() ? link.collisions : link.visuals;
  SymmetricEigen<3> eigen = symmetric_eigen(inertial.inertia);
  const Inertial solid = solid_inertial(shapes, inertial.mass_kg);
  if (eigen.values[2] < 1e-4 * symmetric_eigen(solid.inertia).values[2]) {
    // Tensor of the shape about the given center of mass.
    inertial.inertia = solid.inertia;
    inertial.T_link_inertia.rotation.setIdentity();
    assume(link.name, "its inertia of nearly zero is replaced by that of its shape", "<inertia> of the link");
    return inertial;
  }
  const double max = eigen.values[2];
  const double size_m = box_.isEmpty() ? 0.0 : box_.diagonal().norm();
  constexpr double kNegligible = 0.01;  // to the moment of the whole mass at the size of the robot
  const double limit = std::max(inertial.mass_kg, kNegligible * source_kg_) * size_m * size_m;
  if (chassis_.contains(link.name) && size_m > 0.0 && max > limit) {
    const Shape whole{.type = ShapeType::kBox, .size_m = box_.sizes()};
    inertial.inertia = shapes.empty() ? solid_inertial({whole}, inertial.mass_kg).inertia : solid.inertia;
    inertial.T_link_inertia.rotation.setIdentity();
    assume(link.name,
           fmt::format("its moment of inertia {:.3g} kg m2 is that of its {:.3g} kg at a distance of {:.3g} m, but the "
                       "robot is {:.3g} m large: replaced by that of its shape",
                       max, inertial.mass_kg, std::sqrt(max / inertial.mass_kg), size_m),
           "<inertia> of the link");
    return inertial;
  }
  Eigen::Vector3d& moments = eigen.values;
  constexpr double kMinRatio = 1e-3, kMargin = 1.00005, kBelowSum = 0.9999;
  if (moments[0] >= kMinRatio * 1e-2 * max && moments[2] <= (moments[0] + moments[1]) * kMargin) return inertial;
  moments[0] = std::max(moments[0], kMinRatio * max);
  moments[2] = std::min(moments[2], kBelowSum * (moments[0] + moments[1]));
  inertial.inertia = eigen.vectors * moments.asDiagonal() * eigen.vectors.transpose();
  assume(link.name, "its principal moments of inertia are adjusted by up to 1 %: no body has them",
         "<inertia> of the link");
  return inertial;
}

std::vector<const SourceLink*> Normalizer::moving_group(const SourceJoint& joint) const {
  return rigid_group(source_, joint.child, kept_);
}

/// Returns the inertia of links that move as one, in the frame `T_base_new`; that of `fallback` (in this frame) if the
/// links have no mass. `T_adjust` moves the links in the base.
Inertial Normalizer::moving_inertial(const std::vector<const SourceLink*>& links, const Pose3& T_base_new,
                                     const Pose3& T_adjust, const std::vector<Shape>& fallback,
                                     const SourceJoint& joint) {
  std::vector<std::pair<Pose3, Inertial>> parts;
  for (const SourceLink* link : links) {
    if (const auto inertial = checked_inertial(*link))
      parts.push_back({T_base_new.inverse() * (T_adjust * T_base(link->name)), *inertial});
  }
  if (!parts.empty()) return combine(parts);
  for (const SourceLink* link : links) {
    if (link->inertial) source_.fail(link->inertial->line, link->name, "mass = 0: must be positive for a moving link");
  }
  const Inertial inertial = solid_inertial(fallback, 0.0);
  assume(joint.child,
         fmt::format("has no <inertial>: a mass of {:.3g} kg is assumed, {:.0f} kg/m3 in its shape", inertial.mass_kg,
                     kDensity_kgpm3),
         "<inertial> of the link");
  return inertial;
}

/// Adds base_link and the links that are fixed to it.
void Normalizer::add_chassis() {
  bool has_collision = false, has_visual = false;
  double mass_kg = 0.0;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    has_collision = has_collision || !link.collisions.empty();
    has_visual = has_visual || !link.visuals.empty();
    if (link.inertial) mass_kg += link.inertial->mass_kg;
  }
  if (!has_collision)
    assume("chassis",
           has_visual ? "has no <collision>: contact and footprint are those of the visuals"
                      : "has neither <collision> nor <visual>: it touches nothing, and the footprint is that of the "
                        "wheels or legs",
           "<collision> of the links");
  std::vector<const SourceLink*> links = {&source_.link(base_)};
  for (const SourceLink& link : source_.links) {
    if (chassis_.contains(link.name) && link.name != base_) links.push_back(&link);
  }
  std::set<std::string> above;  // massless links without shapes above the base
  for (const SourceJoint* joint = source_.parent_joint(base_); joint != nullptr;
       joint = source_.parent_joint(joint->parent)) {
    if (!source_.link(joint->parent).has_shapes() && !source_.link(joint->parent).inertial) above.insert(joint->parent);
  }
  for (const SourceLink* link : links) {
    if (above.contains(link->name)) continue;
    NormalizedLink target{.name = link_name(link->name)};
    const Pose3 T_base_link = T_base(link->name);
    Pose3 T_target_link;
    if (link->name == base_) {
      T_target_link = T_base_link;
    } else {
      const SourceJoint* joint = source_.parent_joint(link->name);
      const std::string name = joint_name(joint != nullptr ? joint->name : link->name + "_joint");
      target.joint = NormalizedJoint{.name = name, .parent = "base_link", .T_parent_link = T_base_link};
    }
    add_visuals(*link, T_target_link, target);
    add_collisions(*link, T_target_link, !has_collision, target);
    if (const auto inertial = checked_inertial(*link)) {
      target.inertial = combine({{T_target_link, *inertial}});
    } else if (mass_kg <= 0.0 && link->has_shapes()) {
      std::vector<Shape> shapes = link->collisions.empty() ? link->visuals : link->collisions;
      for (Shape& shape : shapes) shape.T_link_shape = T_target_link * shape.T_link_shape;
      target.inertial = solid_inertial(shapes, 0.0);
      assume(link->name,
             fmt::format("has no <inertial>: a mass of {:.3g} kg is assumed, {:.0f} kg/m3 in its shapes",
                         target.inertial->mass_kg, kDensity_kgpm3),
             "<inertial> of the link");
    } else if (link->has_shapes() && !link->inertial) {
      massless_.push_back(link->name);
    }
    result_.links.push_back(std::move(target));
  }
  if (!massless_.empty()) {
    assume(list_of(massless_),
           std::string(massless_.size() == 1 ? "has" : "have") +
               " no <inertial>: massless, since other links of the chassis have masses",
           "<inertial> of the links");
  }
  // A free body needs a mass of its own: the heaviest fixed link gives it, unless the base has at least a
  // hundredth of the mass of that link.
  constexpr double kMinMass = 0.01;  // to the heaviest link
  NormalizedLink* heaviest = nullptr;
  for (NormalizedLink& link : result_.links) {
    if (link.inertial && (heaviest == nullptr || link.inertial->mass_kg > heaviest->inertial->mass_kg))
      heaviest = &link;
  }
  if (heaviest == nullptr) {
    source_.fail(source_.link(base_).line, base_, "the chassis has neither mass nor shapes");
  }
  if (base().inertial && base().inertial->mass_kg >= kMinMass * heaviest->inertial->mass_kg) return;
  std::vector<std::pair<Pose3, Inertial>> parts = {{heaviest->joint->T_parent_link, *heaviest->inertial}};
  if (base().inertial) parts.push_back({{}, *base().inertial});
  base().inertial = combine(parts);
  heaviest->inertial.reset();
}

double Normalizer::total_mass_kg() const {
  double mass_kg = 0.0;
  for (const NormalizedLink& link : result_.links) {
    if (link.inertial) mass_kg += link.inertial->mass_kg;
  }
  return mass_kg;
}

}  // namespace patrol::importer
