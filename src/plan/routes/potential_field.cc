#include "plan/routes/potential_field.h"

#include <cmath>
#include <optional>

namespace patrol::plan {
namespace {

/// Vector from the nearest lethal cell to this one; none within the range.
std::optional<Eigen::Vector2d> from_nearest_obstacle(const Grid<Cost>& costs, Cell cell, double range) {
  const int radius_cells = static_cast<int>(range);
  std::optional<Eigen::Vector2d> nearest;
  for (int dy = -radius_cells; dy <= radius_cells; ++dy) {
    for (int dx = -radius_cells; dx <= radius_cells; ++dx) {
      const Cell other{cell.col + dx, cell.row + dy};
      if (!costs.contains(other) || costs.at(other) != kLethalCost) continue;
      const Eigen::Vector2d from_obstacle(-dx, -dy);
      if (from_obstacle.norm() < (nearest ? nearest->norm() : range)) nearest = from_obstacle;
    }
  }
  return nearest;
}

}  // namespace

Grid<Eigen::Vector2d> potential_forces(const PotentialFieldSettings& settings, const Grid<Cost>& costs, Cell goal) {
  Grid<Eigen::Vector2d> forces(costs.geometry(), Eigen::Vector2d::Zero());
  for (int row = 0; row < costs.geometry().height; ++row) {
    for (int col = 0; col < costs.geometry().width; ++col) {
      const Cell cell{col, row};
      if (cell == goal || costs.at(cell) == kLethalCost) continue;
      const Eigen::Vector2d to_goal(goal.col - col, goal.row - row);
      const double distance = to_goal.norm();
      Eigen::Vector2d force = settings.attraction * to_goal;
      if (const auto away = from_nearest_obstacle(costs, cell, settings.obstacle_range_cells)) {
        const double rho = away->norm(), nearness = 1.0 / rho - 1.0 / settings.obstacle_range_cells;
        force += settings.repulsion * nearness * distance / (rho * rho) * *away / rho;
        force += 0.5 * settings.repulsion * nearness * nearness * to_goal / distance;
      }
      forces.at(cell) = settings.attraction > 0.0 ? Eigen::Vector2d(force / (settings.attraction * distance)) : force;
    }
  }
  return forces;
}

}  // namespace patrol::plan
