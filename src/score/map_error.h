#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "score/visibility.h"

namespace patrol::score {

/// How well the built map shows the world, with map and world joined at the start and nothing fitted.
///
/// `nearest_*` is precision: from the centre of each occupied cell of the built map to the nearest occupied cell of the
/// reference, seeable or not. It has a floor that no mapping can pass: a cell's centre stands up to half a cell from the
/// surface that it stands for, so with cells of r (built) and q (reference, whose surface cells lie within the solid, half
/// of q behind the surface) a perfect map of straight walls gets a mean of (r/4 + q^2/(4 r)), 1.6 cm for 5 cm and 2.5 cm
/// cells (tests/score/map_error_test.cc shows it).
///
/// `coverage` is recall: the share of the reference's seeable occupied cells that the built map has within 10 cm.
/// `iou` is strict: cells of the built map's size, no tolerance, occupied in both over occupied in either.
struct MapError {
  std::size_t num_occupied = 0;  ///< cells of the built map that were judged
  double nearest_mean_m = 0.0;
  double nearest_var_m2 = 0.0;
  double nearest_p95_m = 0.0;
  double coverage = 0.0;
  double iou = 0.0;
  Grid<float> cells_m;  ///< what `nearest_*` is made of, on the built map's cells; NaN where it is not occupied
};

/// `built` lies in map. Throws InputError when one of the maps has no occupied cell.
MapError map_error(const OccupancyGrid& built, const Pose2& T_world_map, const ReferenceMap& reference);

/// Centres of the occupied cells, m, in the grid's frame.
std::vector<Eigen::Vector2d> occupied_points(const OccupancyGrid& map);

}  // namespace patrol::score
