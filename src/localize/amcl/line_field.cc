#include "localize/amcl/line_field.h"

#include <algorithm>
#include <optional>

#include "core/map_cells.h"
#include "slam/grid_map.h"
#include "slam/local_line.h"

namespace patrol::localize {
namespace {

/// Surface cells of the map, with one hit at each center. Cells inside thick walls are excluded.
slam::GridMap surfaces_of(const OccupancyGrid& map) {
  const GridGeometry& geometry = map.geometry();
  const Eigen::Vector2d far =
      geometry.origin_m.cwiseAbs() + geometry.resolution_m * Eigen::Vector2d(geometry.width, geometry.height);
  slam::GridMap surfaces(geometry.resolution_m, 2.0 * far.maxCoeff() + 10.0);
  const auto is_solid = [&](Cell cell) { return !map.contains(cell) || is_occupied(map.at(cell)); };
  for (int row = 0; row < geometry.height; ++row) {
    for (int col = 0; col < geometry.width; ++col) {
      const bool is_inside =
          is_solid({col - 1, row}) && is_solid({col + 1, row}) && is_solid({col, row - 1}) && is_solid({col, row + 1});
      if (is_occupied(map.at({col, row})) && !is_inside) surfaces.add_hit(geometry.center_of({col, row}));
    }
  }
  return surfaces;
}

}  // namespace

LineField::LineField(const OccupancyGrid& map, int radius_cells)
    : max_distance_m_(radius_cells * map.geometry().resolution_m), index_(map.geometry(), kNone) {
  const slam::GridMap surfaces = surfaces_of(map);
  for (int row = 0; row < map.geometry().height; ++row) {
    for (int col = 0; col < map.geometry().width; ++col) {
      const std::optional<slam::LocalLine> line =
          slam::fit_local_line(surfaces, map.geometry().center_of({col, row}), radius_cells);
      if (!line) continue;
      index_.at({col, row}) = static_cast<std::int32_t>(lines_.size());
      lines_.push_back({line->point_map, line->normal_map, line->normal_var_m2, line->linearity});
    }
  }
}

const SurfaceLine* LineField::find(const Eigen::Vector2d& p_map) const {
  const Cell cell = index_.geometry().cell_at(p_map);
  if (!index_.contains(cell) || index_.at(cell) == kNone) return nullptr;
  return &lines_[static_cast<std::size_t>(index_.at(cell))];
}

}  // namespace patrol::localize
