#pragma once

#include <vector>

#include <Eigen/Core>

#include "importer/mesh.h"

namespace patrol::importer {

/// Returns the convex hull of points, or the hull of those of its corners that approximate it best if it has more than
/// `max_vertices`: starting from a tetrahedron, the point with the largest distance outside is added. Flat point sets
/// are extruded to a thickness of 1 mm. Empty for fewer than three points that are not collinear.
Mesh convex_hull(const std::vector<Eigen::Vector3d>& points_m, int max_vertices);

/// Limits of `convex_pieces`.
struct PieceLimits {
  int max_pieces = 8;
  int max_vertices = 64;     ///< maximum number of vertices of each piece
  double min_size_m = 0.02;  ///< smaller components are dropped if there are larger ones
};

/// Convex pieces that cover a mesh.
struct ConvexPieces {
  std::vector<Mesh> pieces;
  int num_dropped = 0;  ///< components smaller than the minimum size, or inside another piece
  int num_merged = 0;   ///< components merged with a neighbor because of the maximum number of pieces
};

/// Returns the convex hull of each connected component, largest first.
ConvexPieces convex_pieces(const Mesh& mesh, const PieceLimits& limits = {});

}  // namespace patrol::importer
