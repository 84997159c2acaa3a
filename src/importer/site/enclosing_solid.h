#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace patrol::importer {

/// Whether a robot can touch a geom.
bool is_touchable(const mjModel& site, int geom);

/// Returns the name of a geom with contact that contains a point in world; none if there is none. Meshes count by their
/// convex hulls, as in contacts. Planes and height fields contain nothing.
std::optional<std::string> enclosing_solid(const mjModel& site, const mjData& data, const Eigen::Vector3d& point_m);

/// Whether the first surface that lidars see above a point in world faces up, as inside of a body without an interior.
bool is_below_back_face(const mjModel& site, const mjData& data, const Eigen::Vector3d& point_m);

}  // namespace patrol::importer
