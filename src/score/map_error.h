#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/grid.h"
#include "score/distance_field.h"
#include "score/visibility.h"

namespace patrol::score {

/// Accuracy of the built map, placed in the reference by the caller.
///
/// `nearest_*` is precision: the distance from the center of each occupied cell of the built map to the nearest
/// occupied cell of the reference, observable or not. It has a lower limit that no mapping method can pass, because a
/// cell's center lies up to half a cell from the surface. With cells of size r (built) and q (reference), a perfect map
/// of straight walls has a mean of r/4 + q^2/(4 r). The reference's surface cells lie within the solid, half of q
/// behind the surface. For cells of 5 cm and 2.5 cm the mean is 1.6 cm (tests/score/map_error_test.cc).
///
/// `coverage` is recall: the fraction of the reference's observable occupied cells that have an occupied cell of the
/// built map within 10 cm. `iou` is the intersection over union of occupied cells in the built map's grid, without
/// tolerance.
struct MapError {
  std::size_t num_occupied = 0;  ///< number of occupied cells of the built map
  double nearest_mean_m = 0.0;
  double nearest_var_m2 = 0.0;
  double nearest_p95_m = 0.0;
  double coverage = 0.0;
  double iou = 0.0;
  /// distances behind `nearest_*` on the built map's cells, m; NaN for cells that are not occupied
  Grid<float> cells_m;
};

/// Compares a built map (in map) with the reference. Throws InputError when the built map has no occupied cell, or the
/// reference has no observable occupied cell.
MapError map_error(const OccupancyGrid& built, const Pose2& T_world_map, const ReferenceMap& reference);
/// Map error with a given distance field of the reference's occupied cells, which takes most of the time.
MapError map_error(const OccupancyGrid& built, const Pose2& T_world_map, const ReferenceMap& reference,
                   const DistanceField& reference_field);

/// Centers of the occupied cells in the grid's frame, m.
std::vector<Eigen::Vector2d> occupied_points(const OccupancyGrid& map);

}  // namespace patrol::score
