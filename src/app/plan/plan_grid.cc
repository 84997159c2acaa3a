#include "app/plan/plan_grid.h"

#include <algorithm>
#include <cmath>

#include "plan/routes/global_planner.h"

namespace patrol::app {
namespace {

Grid<plan::Cost> costs_of_point(const OccupancyGrid& occupancy, const plan::CostmapSettings& settings) {
  Grid<plan::Cost> costs(occupancy.geometry(), plan::kFreeCost);
  for (std::size_t i = 0; i < costs.values().size(); ++i) {
    const std::int8_t value = occupancy.values()[i];
    if (value == kUnknown ? !settings.allow_unknown : value >= settings.occupied_percent)
      costs.values()[i] = plan::kLethalCost;
  }
  return costs;
}

}  // namespace

Grid<plan::Cost> make_costs(const OccupancyGrid& occupancy, const PlanBody& body,
                            const plan::CostmapSettings& settings) {
  if (!body.footprint) return costs_of_point(occupancy, settings);
  plan::CostmapSettings drives_with = settings;
  drives_with.resolution_m = std::max(settings.resolution_m, occupancy.geometry().resolution_m);
  // The costmap always contains its frame's origin, however far the map is from it. So the map is moved there, by
  // whole cells.
  const double cell_m = drives_with.resolution_m;
  const Eigen::Vector2d corner_m = cell_m * (occupancy.geometry().origin_m.array() / cell_m).floor();
  GridGeometry moved = occupancy.geometry();
  moved.origin_m -= corner_m;
  OccupancyGrid moved_map(moved);
  moved_map.values() = occupancy.values();
  plan::Costmap costmap(drives_with, *body.footprint, {});
  costmap.set_map(moved_map);

  const Eigen::Array2d end =
      (moved.origin_m + moved.resolution_m * Eigen::Vector2d(moved.width, moved.height)).array() / cell_m;
  constexpr double kRounding = 1e-6;  // cells
  Grid<plan::Cost> costs({.resolution_m = cell_m,
                          .width = static_cast<int>(std::ceil(end.x() - kRounding)),
                          .height = static_cast<int>(std::ceil(end.y() - kRounding)),
                          .origin_m = corner_m});
  const Cell first = costmap.geometry().cell_at({0.5 * cell_m, 0.5 * cell_m});
  for (int row = 0; row < costs.geometry().height; ++row) {
    const plan::Cost* from = &costmap.cost().at({first.col, first.row + row});
    std::copy(from, from + costs.geometry().width, &costs.at({0, row}));
  }
  return costs;
}

std::int64_t num_passable(const Grid<plan::Cost>& costs) {
  return std::count_if(costs.values().begin(), costs.values().end(),
                       [](plan::Cost cost) { return cost != plan::kLethalCost; });
}

std::optional<Cell> nearest_free(const Grid<plan::Cost>& costs, const Eigen::Vector2d& p_m) {
  const GridGeometry& grid = costs.geometry();
  const double diagonal_m = grid.resolution_m * std::hypot(grid.width, grid.height);
  for (double radius_m = 4.0 * grid.resolution_m;; radius_m *= 2.0) {
    const std::optional<Cell> cell = plan::nearest_passable(costs, p_m, radius_m);
    if (cell || radius_m > diagonal_m) return cell;
  }
}

const char* blocked_reason(const OccupancyGrid& occupancy, const plan::CostmapSettings& settings,
                           const Eigen::Vector2d& p_m) {
  const std::int8_t value = occupancy.at(occupancy.geometry().cell_at(p_m));
  if (value >= settings.occupied_percent) return "is occupied";
  if (value == kUnknown && !settings.allow_unknown) return "is unknown in the map";
  return "is too close to an obstacle";
}

}  // namespace patrol::app
