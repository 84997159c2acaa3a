#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "importer/mesh.h"

namespace patrol::importer {

/// Ground of a site as heights at the centers of cells.
struct GroundSurface {
  Grid<float> height_m;  ///< height of every cell: that of the ground, of a drop beside it, or of the nearest ground
  std::vector<char> is_ground = {};  ///< [cell]; 0: the height is that of a drop or of the nearest ground
  double area_m2 = 0.0;              ///< area of the ground without filled cells; 0: a given floor below the whole grid
  double own_area_m2 = 0.0;          ///< area of the ground that belongs to the mesh and not to the given surfaces
  bool is_found = false;    ///< false: no walkable surface of at least 1 m2; the heights are the lowest of the mesh
  bool is_oriented = true;  ///< false: the triangles of the mesh face both sides, and do not tell top and underside
  bool faces_up = true;     ///< most of the ground's triangles are counterclockwise seen from above; if not oriented:
                            ///< most of the ground has 1 m of free height

  /// Returns the height at a point, interpolated between the centers of cells.
  double at(const Eigen::Vector2d& p_m) const;
};

/// Finds the ground as described at `contact_geometry`. A `start` beside the grid is on a given surface. Throws
/// InputError without file if there is no walkable surface at `start`.
GroundSurface find_ground(const Mesh& mesh, const Mesh& given, const GridGeometry& grid,
                          const std::optional<Eigen::Vector2d>& start);

}  // namespace patrol::importer
