#include "app/plan/tour_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "app/plan/route_metrics.h"
#include "app/common/process_cost.h"
#include "app/common/progress_bar.h"

namespace patrol::app {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Paths between all pairs of places.
class Ways {
 public:
  Ways(const Grid<plan::Cost>& costs, std::vector<Cell> places, const PlanSettings& settings)
      : costs_(costs), places_(std::move(places)), settings_(settings), planner_(plan::make_route_planner(settings.planner, settings.routes, settings.seed)) {}

  std::size_t size() const { return places_.size(); }

  /// Plans the path of a pair for both directions, from the place with the lower index.
  void plan(std::size_t from, std::size_t to) {
    const auto key = std::minmax(from, to);
    ways_[key] = plan_route(*planner_, costs_, places_[key.first], places_[key.second], settings_);
  }
  double length_m(std::size_t from, std::size_t to) const {
    if (from == to) return 0.0;
    const plan::Route& way = ways_.at(std::minmax(from, to));
    return way.status == plan::PlanStatus::kFound ? costs_.geometry().resolution_m * way.length : kInfinite;
  }
  /// Whether the existence or absence of a path is proven.
  bool is_proved(std::size_t from, std::size_t to) const { return ways_.at(std::minmax(from, to)).status != plan::PlanStatus::kNotFound; }
  std::vector<Eigen::Vector2d> points_m(std::size_t from, std::size_t to) const {
    std::vector<Eigen::Vector2d> points_m = plan::to_meters(costs_.geometry(), ways_.at(std::minmax(from, to)).points);
    if (from > to) std::reverse(points_m.begin(), points_m.end());
    return points_m;
  }

 private:
  const Grid<plan::Cost>& costs_;
  std::vector<Cell> places_;
  const PlanSettings& settings_;
  std::unique_ptr<plan::RoutePlanner> planner_;
  std::map<std::pair<std::size_t, std::size_t>, plan::Route> ways_;
};

/// Plans all `pairs`; false if interrupted.
bool plan_ways(Ways& ways, const std::vector<std::pair<std::size_t, std::size_t>>& pairs, const InterruptGuard& guard, ProgressBar& bar) {
  double shown_s = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    ways.plan(pairs[i].first, pairs[i].second);
    if (guard.is_interrupted()) return false;
    if (const double now_s = wall_seconds(); now_s - shown_s > 0.1) {
      shown_s = now_s;
      bar.show(fmt::format("{} of {} ways", i + 1, pairs.size()));
    }
  }
  return true;
}

/// Tour problem of the reachable places; `places[i]` is its station i.
plan::TourProblem problem_of(const Ways& ways, const std::vector<std::size_t>& places, const std::vector<TourStop>& stops, bool has_end, double speed_mps) {
  plan::TourProblem problem{.start = 0, .end = has_end ? places.size() - 1 : 0};
  for (const std::size_t from : places) {
    problem.travel.emplace_back();
    for (const std::size_t to : places) problem.travel.back().push_back(ways.length_m(from, to) / speed_mps);
    const bool is_stop = from > 0 && from <= stops.size();
    const io::TourStation station = is_stop ? stops[from - 1].station : io::TourStation{};
    problem.stations.push_back({.service = station.service_s, .earliest = station.earliest_s, .latest = station.latest_s, .priority = station.priority});
  }
  return problem;
}

std::vector<TourVisit> visits_of(const Ways& ways, const std::vector<std::size_t>& route, const std::vector<TourStop>& stops, double speed_mps) {
  std::vector<TourVisit> visits;
  double now_s = 0.0;
  for (std::size_t k = 0; k < route.size(); ++k) {
    TourVisit visit{.place = route[k], .leg_m = k == 0 ? 0.0 : ways.length_m(route[k - 1], route[k])};
    const io::TourStation station = route[k] > 0 && route[k] <= stops.size() ? stops[route[k] - 1].station : io::TourStation{};
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

std::optional<TourPlan> plan_tour(const Grid<plan::Cost>& costs, const Eigen::Vector2d& p_start_m, const std::vector<TourStop>& stops,
                                  const std::optional<Eigen::Vector2d>& p_end_m, const PlanSettings& settings) {
  std::vector<Cell> cells = {costs.geometry().cell_at(p_start_m)};
  for (const TourStop& stop : stops) cells.push_back(costs.geometry().cell_at(stop.p_m));
  if (p_end_m) cells.push_back(costs.geometry().cell_at(*p_end_m));
  Ways ways(costs, cells, settings);

  InterruptGuard guard;
  ProgressBar bar;
  TourPlan tour;
  const double processor_s = process_seconds();
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t place = 1; place < ways.size(); ++place) pairs.emplace_back(0, place);
  if (!plan_ways(ways, pairs, guard, bar)) return std::nullopt;
  tour.num_routes = static_cast<int>(pairs.size());
  tour.processor_s = process_seconds() - processor_s;
  std::vector<std::size_t> places = {0};
  for (std::size_t place = 1; place < ways.size(); ++place) {
    (std::isinf(ways.length_m(0, place)) ? tour.unreachable : places).push_back(place);
    tour.is_proved = tour.is_proved && ways.is_proved(0, place);
  }
  const bool has_end = p_end_m.has_value();
  if (places.size() == 1 || (has_end && places.back() != ways.size() - 1)) return tour;
  pairs.clear();
  for (std::size_t i = 1; i < places.size(); ++i) {
    for (std::size_t j = i + 1; j < places.size(); ++j) pairs.emplace_back(places[i], places[j]);
  }
  if (!plan_ways(ways, pairs, guard, bar)) return std::nullopt;
  tour.num_routes += static_cast<int>(pairs.size());
  tour.processor_s = process_seconds() - processor_s;

  bar.show("the order of the stations");
  tour.order = plan::solve_station_order(problem_of(ways, places, stops, has_end, settings.speed_mps), settings.tour, settings.seed);
  if (!tour.order.is_found) return tour;
  std::vector<std::size_t> route;
  for (const std::size_t station : tour.order.stations) route.push_back(places[station]);
  if (!has_end) route.push_back(0);
  tour.visits = visits_of(ways, route, stops, settings.speed_mps);
  for (std::size_t k = 1; k < route.size(); ++k) {
    const std::vector<Eigen::Vector2d> leg_m = ways.points_m(route[k - 1], route[k]);
    tour.points_m.insert(tour.points_m.end(), leg_m.begin() + (tour.points_m.empty() ? 0 : 1), leg_m.end());
  }
  return tour;
}

}  // namespace patrol::app
