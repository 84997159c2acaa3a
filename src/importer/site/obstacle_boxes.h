#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "importer/mesh.h"
#include "importer/site/ground_surface.h"

namespace patrol::importer {

/// Returns boxes around the parts of the triangles that are more than `tolerance_m` and up to `height_m` above the
/// ground. Boxes consist of whole cells of the ground's grid; their tops and bottoms are on whole centimeters. A box is
/// at least a cell thick, which is added below. Cells are merged to a rectangle while the tops are equal and the
/// bottoms differ by at most a cell.
std::vector<Eigen::AlignedBox3d> obstacle_boxes(const Mesh& mesh, const GroundSurface& ground, double tolerance_m,
                                                double height_m);

}  // namespace patrol::importer
