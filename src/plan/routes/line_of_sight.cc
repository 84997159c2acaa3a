#include "plan/routes/line_of_sight.h"

#include <cmath>

namespace patrol::plan {

std::optional<double> line_cost(const Grid<Cost>& costs, const std::array<double, 256>& factors, Cell from, Cell to) {
  double mean_factor = 0.0;
  const bool is_clear = visit_line_cells(from, to, [&](Cell cell, double fraction) {
    mean_factor += fraction * factors[costs.at(cell)];
    return costs.at(cell) != kLethalCost;
  });
  if (!is_clear) return std::nullopt;
  return mean_factor * std::hypot(to.col - from.col, to.row - from.row);
}

}  // namespace patrol::plan
