#include "score/map_error.h"

#include <limits>

#include "core/error.h"
#include "score/statistics.h"

namespace patrol::score {
namespace {

constexpr double kCoveredWithin_m = 0.10 + 1e-6;  // margin for float distances: two cells of 5 cm are within 10 cm

std::vector<Eigen::Vector2d> centers_of(const Grid<std::uint8_t>& marked) {
  std::vector<Eigen::Vector2d> points;
  const GridGeometry& geometry = marked.geometry();
  for (int row = 0; row < geometry.height; ++row) {
    for (int col = 0; col < geometry.width; ++col) {
      if (marked.at({col, row}) != 0) points.push_back(geometry.center_of({col, row}));
    }
  }
  return points;
}

std::vector<double> distances_m(const DistanceField& field, const Pose2& T_field_points,
                                const std::vector<Eigen::Vector2d>& points) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector2d& p : points) distances.push_back(field.distance_m(T_field_points * p));
  return distances;
}

/// Writes the distances to a grid, on the marked cells, in the order of `centers_of`.
Grid<float> on_cells(const Grid<std::uint8_t>& marked, const std::vector<double>& distances) {
  Grid<float> cells(marked.geometry(), std::numeric_limits<float>::quiet_NaN());
  std::size_t next = 0;
  for (std::size_t i = 0; i < marked.values().size(); ++i) {
    if (marked.values()[i] != 0) cells.values()[i] = static_cast<float>(distances[next++]);
  }
  return cells;
}

double fraction_within(const std::vector<double>& values, double limit) {
  std::size_t within = 0;
  for (const double value : values) within += value <= limit ? 1 : 0;
  return values.empty() ? 0.0 : static_cast<double>(within) / static_cast<double>(values.size());
}

/// Intersection over union in the built map's cells. Reference points outside the built map count as missed.
double intersection_over_union(const Grid<std::uint8_t>& built, const Pose2& T_map_world,
                               const std::vector<Eigen::Vector2d>& reference_points) {
  Grid<std::uint8_t> reference(built.geometry());
  std::size_t outside = 0;
  for (const Eigen::Vector2d& p_world : reference_points) {
    const Cell cell = built.geometry().cell_at(T_map_world * p_world);
    if (reference.contains(cell)) reference.at(cell) = 1;
    else ++outside;
  }
  std::size_t both = 0, either = outside;
  for (std::size_t i = 0; i < built.values().size(); ++i) {
    both += built.values()[i] != 0 && reference.values()[i] != 0 ? 1 : 0;
    either += built.values()[i] != 0 || reference.values()[i] != 0 ? 1 : 0;
  }
  return either == 0 ? 0.0 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace

std::vector<Eigen::Vector2d> occupied_points(const OccupancyGrid& map) { return centers_of(occupied_cells(map)); }

MapError map_error(const OccupancyGrid& built, const Pose2& T_world_map, const ReferenceMap& reference) {
  return map_error(built, T_world_map, reference, DistanceField(occupied_cells(reference.cells)));
}

MapError map_error(const OccupancyGrid& built, const Pose2& T_world_map, const ReferenceMap& reference,
                   const DistanceField& reference_field) {
  const Grid<std::uint8_t> built_occupied = occupied_cells(built);
  const std::vector<Eigen::Vector2d> built_points = centers_of(built_occupied);
  const std::vector<Eigen::Vector2d> observable_points = centers_of(occupied_cells(observable_part(reference)));
  if (built_points.empty()) throw InputError("built map: no occupied cells");
  if (observable_points.empty()) throw InputError("reference map: no observable occupied cells");

  const std::vector<double> nearest_m = distances_m(reference_field, T_world_map, built_points);
  const Pose2 T_map_world = T_world_map.inverse();
  const std::vector<double> recall_distances_m =
      distances_m(DistanceField(built_occupied), T_map_world, observable_points);
  return {.num_occupied = built_points.size(),
          .nearest_mean_m = mean(nearest_m),
          .nearest_var_m2 = variance(nearest_m),
          .nearest_p95_m = percentile(nearest_m, 0.95),
          .coverage = fraction_within(recall_distances_m, kCoveredWithin_m),
          .iou = intersection_over_union(built_occupied, T_map_world, observable_points),
          .cells_m = on_cells(built_occupied, nearest_m)};
}

}  // namespace patrol::score
