#include "app/plan/tour_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/common/progress_bar.h"
#include "app/plan/route_metrics.h"

namespace patrol::app {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Paths between all pairs of places.
class PairwisePaths {
 public:
  PairwisePaths(const Grid<plan::Cost>& costs, std::vector<Cell> nodes, const PlanSettings& settings)
      : costs_(costs),
        nodes_(std::move(nodes)),
        settings_(settings),
        planner_(plan::make_route_planner(settings.planner, settings.routes, settings.seed)) {}

  std::size_t size() const { return nodes_.size(); }

  /// Plans the path of a pair for both directions, from the place with the lower index.
  void plan(std::size_t from, std::size_t to) {
    const auto key = std::minmax(from, to);
    paths_[key] = plan_route(*planner_, costs_, nodes_[key.first], nodes_[key.second], settings_);
  }
  double length_m(std::size_t from, std::size_t to) const {
    if (from == to) return 0.0;
    const plan::Route& path = paths_.at(std::minmax(from, to));
    return path.status == plan::PlanStatus::kFound ? costs_.geometry().resolution_m * path.length : kInfinite;
  }
  /// Whether the existence or absence of a path is proven.
  bool is_proven(std::size_t from, std::size_t to) const {
    return paths_.at(std::minmax(from, to)).status != plan::PlanStatus::kNotFound;
  }
  std::vector<Eigen::Vector2d> points_m(std::size_t from, std::size_t to) const {
    std::vector<Eigen::Vector2d> points_m = plan::to_meters(costs_.geometry(), paths_.at(std::minmax(from, to)).points);
    if (from > to) std::reverse(points_m.begin(), points_m.end());
    return points_m;
  }

 private:
  const Grid<plan::Cost>& costs_;
  std::vector<Cell> nodes_;
  const PlanSettings& settings_;
  std::unique_ptr<plan::RoutePlanner> planner_;
  std::map<std::pair<std::size_t, std::size_t>, plan::Route> paths_;
};

/// Plans all `pairs`; false if interrupted.
bool plan_paths(PairwisePaths& paths, const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
                const InterruptGuard& guard, ProgressBar& bar) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    paths.plan(pairs[i].first, pairs[i].second);
    if (guard.is_interrupted()) return false;
    bar.show(fmt::format("{} of {} paths", i + 1, pairs.size()),
             static_cast<double>(i + 1) / static_cast<double>(pairs.size()));
  }
  return true;
}

/// Tour problem of the reachable places; `places[i]` is its station i.
plan::TourProblem problem_of(const PairwisePaths& paths, const std::vector<std::size_t>& nodes,
                             const std::vector<TourStop>& stops, bool has_end, double speed_mps) {
  plan::TourProblem problem{.start = 0, .end = has_end ? nodes.size() - 1 : 0};
  for (const std::size_t from : nodes) {
    problem.travel.emplace_back();
    for (const std::size_t to : nodes) problem.travel.back().push_back(paths.length_m(from, to) / speed_mps);
    const bool is_stop = from > 0 && from <= stops.size();
    const io::TourStation station = is_stop ? stops[from - 1].station : io::TourStation{};
    problem.stations.push_back({.service = station.service_s,
                                .earliest = station.earliest_s,
                                .latest = station.latest_s,
                                .priority = station.priority});
  }
  return problem;
}

std::vector<TourVisit> visits_of(const PairwisePaths& paths, const std::vector<std::size_t>& route,
                                 const std::vector<TourStop>& stops, double speed_mps) {
  std::vector<TourVisit> visits;
  double now_s = 0.0;
  for (std::size_t k = 0; k < route.size(); ++k) {
    TourVisit visit{.node = route[k], .leg_m = k == 0 ? 0.0 : paths.length_m(route[k - 1], route[k])};
    const io::TourStation station =
        route[k] > 0 && route[k] <= stops.size() ? stops[route[k] - 1].station : io::TourStation{};
    visit.arrives_s = now_s + visit.leg_m / speed_mps;
    visit.waits_s = std::max(0.0, station.earliest_s - visit.arrives_s);
    visit.late_s = std::max(0.0, visit.arrives_s - station.latest_s);
    visit.leaves_s = visit.arrives_s + visit.waits_s + station.service_s;
    now_s = visit.leaves_s;
    visits.push_back(visit);
  }
  return visits;
}

}  // namespace

std::optional<TourPlan> plan_tour(const Grid<plan::Cost>& costs, const Eigen::Vector2d& p_start_m,
                                  const std::vector<TourStop>& stops, const std::optional<Eigen::Vector2d>& p_end_m,
                                  const PlanSettings& settings) {
  std::vector<Cell> cells = {costs.geometry().cell_at(p_start_m)};
  for (const TourStop& stop : stops) cells.push_back(costs.geometry().cell_at(stop.p_m));
  if (p_end_m) cells.push_back(costs.geometry().cell_at(*p_end_m));
  PairwisePaths paths(costs, cells, settings);

  InterruptGuard guard;
  ProgressBar bar;
  TourPlan tour;
  const double processor_s = process_seconds();
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t node = 1; node < paths.size(); ++node) pairs.emplace_back(0, node);
  if (!plan_paths(paths, pairs, guard, bar)) return std::nullopt;
  tour.num_routes = static_cast<int>(pairs.size());
  tour.processor_s = process_seconds() - processor_s;
  std::vector<std::size_t> nodes = {0};
  for (std::size_t node = 1; node < paths.size(); ++node) {
    (std::isinf(paths.length_m(0, node)) ? tour.unreachable : nodes).push_back(node);
    tour.is_proven = tour.is_proven && paths.is_proven(0, node);
  }
  const bool has_end = p_end_m.has_value();
  if (nodes.size() == 1 || (has_end && nodes.back() != paths.size() - 1)) return tour;
  pairs.clear();
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < nodes.size(); ++j) pairs.emplace_back(nodes[i], nodes[j]);
  }
  if (!plan_paths(paths, pairs, guard, bar)) return std::nullopt;
  tour.num_routes += static_cast<int>(pairs.size());
  tour.processor_s = process_seconds() - processor_s;

  bar.show("the order of the stations");
  tour.order = plan::solve_station_order(problem_of(paths, nodes, stops, has_end, settings.speed_mps), settings.tour,
                                         settings.seed);
  if (!tour.order.is_found) return tour;
  std::vector<std::size_t> route;
  for (const std::size_t station : tour.order.stations) route.push_back(nodes[station]);
  if (!has_end) route.push_back(0);
  tour.visits = visits_of(paths, route, stops, settings.speed_mps);
  for (std::size_t k = 1; k < route.size(); ++k) {
    const std::vector<Eigen::Vector2d> leg_m = paths.points_m(route[k - 1], route[k]);
    tour.points_m.insert(tour.points_m.end(), leg_m.begin() + (tour.points_m.empty() ? 0 : 1), leg_m.end());
  }
  return tour;
}

}  // namespace patrol::app
