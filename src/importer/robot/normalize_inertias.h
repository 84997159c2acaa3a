#pragma once

#include <optional>
#include <vector>

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

inline constexpr double kDensity_kgpm3 = 500.0;  // of a link without mass

inline Inertial to_inertial(const SourceInertial& source) {
  return {.mass_kg = source.mass_kg, .T_link_inertia = source.T_link_inertia, .inertia = source.inertia};
}

/// Returns the inertia of solid shapes of one density with a given mass; 0: the density of a link without mass.
Inertial solid_inertial(const std::vector<Shape>& shapes, double mass_kg);

/// Returns the inertia of a link, with moments that no body has corrected.
std::optional<Inertial> checked_inertial(const RobotLayout& layout, const SourceLink& link,
                                         std::vector<Assumption>& rows);

/// Returns the inertia of links that move as one, in the frame `T_base_new`; that of `fallback` (in this frame) if the
/// links have no mass. `T_adjust` moves the links in the base.
Inertial moving_inertial(const RobotLayout& layout, const std::vector<const SourceLink*>& links,
                         const Pose3& T_base_new, const Pose3& T_adjust, const std::vector<Shape>& fallback,
                         const SourceJoint& joint, std::vector<Assumption>& rows);

}  // namespace patrol::importer
