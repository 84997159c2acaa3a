#include "importer/robot/normalize_inertias.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/linear_algebra.h"

namespace patrol::importer {

Inertial solid_inertial(const std::vector<Shape>& shapes, double mass_kg) {
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

std::optional<Inertial> checked_inertial(const RobotLayout& layout, const SourceLink& link,
                                         std::vector<Assumption>& rows) {
  if (!link.inertial) return std::nullopt;
  if (link.inertial->mass_kg <= 0.0) {
    rows.push_back({link.name, "its <inertial> with mass 0 is left out", "<mass> of the link"});
    return std::nullopt;
  }
  Inertial inertial = to_inertial(*link.inertial);
  const std::vector<Shape>& shapes = bounding_shapes(link);
  SymmetricEigen<3> eigen = symmetric_eigen(inertial.inertia);
  const Inertial solid = solid_inertial(shapes, inertial.mass_kg);
  if (eigen.values[2] < 1e-4 * symmetric_eigen(solid.inertia).values[2]) {
    // Tensor of the shape about the given center of mass.
    inertial.inertia = solid.inertia;
    inertial.T_link_inertia.rotation.setIdentity();
    rows.push_back({link.name, "its inertia of nearly zero is replaced by that of its shape", "<inertia> of the link"});
    return inertial;
  }
  const double max = eigen.values[2];
  const double size_m = layout.extent.size_m();
  constexpr double kNegligible = 0.01;  // to the moment of the whole mass at the size of the robot
  const double limit = std::max(inertial.mass_kg, kNegligible * layout.extent.mass_kg) * size_m * size_m;
  if (layout.chassis.contains(link.name) && size_m > 0.0 && max > limit) {
    const Shape whole{.type = ShapeType::kBox, .size_m = layout.extent.box.sizes()};
    inertial.inertia = shapes.empty() ? solid_inertial({whole}, inertial.mass_kg).inertia : solid.inertia;
    inertial.T_link_inertia.rotation.setIdentity();
    rows.push_back(
        {link.name,
         fmt::format("its moment of inertia {:.3g} kg m2 is that of its {:.3g} kg at a distance of {:.3g} m, but the "
                     "robot is {:.3g} m large: replaced by that of its shape",
                     max, inertial.mass_kg, std::sqrt(max / inertial.mass_kg), size_m),
         "<inertia> of the link"});
    return inertial;
  }
  Eigen::Vector3d& moments = eigen.values;
  constexpr double kMinRatio = 1e-3, kMargin = 1.00005, kBelowSum = 0.9999;
  if (moments[0] >= kMinRatio * 1e-2 * max && moments[2] <= (moments[0] + moments[1]) * kMargin) return inertial;
  moments[0] = std::max(moments[0], kMinRatio * max);
  moments[2] = std::min(moments[2], kBelowSum * (moments[0] + moments[1]));
  inertial.inertia = eigen.vectors * moments.asDiagonal() * eigen.vectors.transpose();
  rows.push_back({link.name, "its principal moments of inertia are adjusted by up to 1 %: no body has them",
                  "<inertia> of the link"});
  return inertial;
}

Inertial moving_inertial(const RobotLayout& layout, const std::vector<const SourceLink*>& links,
                         const Pose3& T_base_new, const Pose3& T_adjust, const std::vector<Shape>& fallback,
                         const SourceJoint& joint, std::vector<Assumption>& rows) {
  std::vector<std::pair<Pose3, Inertial>> parts;
  for (const SourceLink* link : links) {
    if (const auto inertial = checked_inertial(layout, *link, rows))
      parts.push_back({T_base_new.inverse() * (T_adjust * layout.T_base(link->name)), *inertial});
  }
  if (!parts.empty()) return combine(parts);
  for (const SourceLink* link : links) {
    if (link->inertial)
      layout.source.fail(link->inertial->line, link->name, "mass = 0: must be positive for a moving link");
  }
  const Inertial inertial = solid_inertial(fallback, 0.0);
  rows.push_back({joint.child,
                  fmt::format("has no <inertial>: a mass of {:.3g} kg is assumed, {:.0f} kg/m3 in its shape",
                              inertial.mass_kg, kDensity_kgpm3),
                  "<inertial> of the link"});
  return inertial;
}

}  // namespace patrol::importer
