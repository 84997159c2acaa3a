#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace patrol::importer {

/// Returns the name of a geom with contact that contains a point in world; none if there is none. Meshes count by their
/// convex hulls, as in contacts. Planes and height fields contain nothing.
std::optional<std::string> enclosing_solid(const mjModel& site, const mjData& data, const Eigen::Vector3d& point_m);

}  // namespace patrol::importer
