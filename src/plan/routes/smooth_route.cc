#include "plan/routes/smooth_route.h"

#include <algorithm>
#include <array>
#include <optional>

#include "plan/routes/line_of_sight.h"
#include "plan/routes/planned_path.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

std::vector<Eigen::Vector2d> smooth_route(const Grid<Cost>& costs, double cost_weight, double min_clearance,
                                          const std::vector<Eigen::Vector2d>& points) {
  constexpr double kRounding = 1e-9;
  if (points.size() < 3) return points;
  const std::array<double, 256> factors = cost_factors(cost_weight);
  std::vector<double> cost_to{0.0}, clearance;  // [point], cost along the route; [leg]
  for (std::size_t i = 1; i < points.size(); ++i) {
    cost_to.push_back(cost_to.back() + line_cost(costs, factors, cell_of(points[i - 1]), cell_of(points[i])).value());
    clearance.push_back(compute_clearance(costs, {points[i - 1], points[i]}, min_clearance));
  }
  const auto may_join = [&](std::size_t from, std::size_t to) {
    const std::optional<double> line = line_cost(costs, factors, cell_of(points[from]), cell_of(points[to]));
    if (!line || *line > (cost_to[to] - cost_to[from]) * (1.0 + kRounding)) return false;
    const auto leg = [&](std::size_t i) { return clearance.begin() + static_cast<std::ptrdiff_t>(i); };
    return compute_clearance(costs, {points[from], points[to]}, min_clearance) >=
           *std::min_element(leg(from), leg(to)) - kRounding;
  };
  std::vector<Eigen::Vector2d> smooth;
  for (const std::size_t i : join_points(points.size(), may_join)) smooth.push_back(points[i]);
  return smooth;
}

}  // namespace patrol::plan
