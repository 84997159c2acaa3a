#pragma once

#include <vector>

#include <Eigen/Core>

#include "importer/mesh.h"

namespace patrol::importer {

/// Returns the prism over a simple polygon, from z = 0 to `height_m`, by ear clipping; empty if
/// the polygon is not simple. The corners run in either direction; a last one equal to the first is left out.
Mesh extruded_polygon(std::vector<Eigen::Vector2d> corners_m, double height_m);

/// Returns a cone about the z axis as a pyramid with 32 sides inside of it: its base is at -length / 2, its tip at
/// length / 2.
Mesh cone(double radius_m, double length_m);

}  // namespace patrol::importer
