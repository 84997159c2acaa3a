#include "stack/mission/station_order.h"

#include <limits>

#include <fmt/format.h>

#include "plan/routes/global_planner.h"
#include "plan/routes/station_order.h"

namespace patrol::stack {
namespace {

constexpr double kMapMargin_m = 10.0;  ///< margin of the map around the stations

/// Returns the robot's start, then the stations.
std::vector<Eigen::Vector2d> to_positions(const std::vector<Station>& stations) {
  std::vector<Eigen::Vector2d> positions{Eigen::Vector2d::Zero()};
  for (const Station& station : stations) positions.push_back(station.T_route_body.position());
  return positions;
}

/// Returns the path lengths, [from][to], m; infinite if there is no path.
std::vector<std::vector<double>> lengths_between(const std::vector<Eigen::Vector2d>& positions,
                                                 const plan::Costmap& costmap, plan::GlobalPlanner& planner) {
  std::vector<std::vector<double>> lengths(positions.size(), std::vector<double>(positions.size(), 0.0));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t j = i + 1; j < positions.size(); ++j) {
      const plan::PlanResult plan = planner.plan(costmap.cost(), positions[i], positions[j]);
      lengths[i][j] = lengths[j][i] =
          plan.status == plan::PlanStatus::kFound ? plan.length_m : std::numeric_limits<double>::infinity();
    }
  }
  return lengths;
}

plan::TourProblem problem_of(const std::vector<Station>& stations, std::vector<std::vector<double>> lengths_m,
                             const GasMissionSettings& mission) {
  plan::TourProblem problem{
      .travel = std::move(lengths_m), .stations = {{.service = mission.init_wait_s}}, .start = 0, .end = {}};
  for (std::vector<double>& row : problem.travel) {
    for (double& travel : row) travel /= mission.expected_speed_mps;
  }
  for (const Station& station : stations) {
    if (station.type == StationType::kHome) problem.end = problem.stations.size();
    problem.stations.push_back({.service = station.type == StationType::kInspect
                                               ? mission.settling_time_s + mission.measurement_duration_s
                                               : 0.0,
                                .earliest = station.earliest_s,
                                .latest = station.latest_s,
                                .priority = station.priority});
  }
  return problem;
}

}  // namespace

StationOrder order_stations(const Route& route_in_map, const RobotDescription& robot,
                            const plan::NavigatorSettings& navigation, const GasMissionSettings& mission,
                            std::uint64_t seed) {
  plan::Costmap costmap(navigation.costmap, plan::Footprint(robot.footprint_m, navigation.footprint_rows),
                        route_in_map.keep_out_lines);
  costmap.set_map(OccupancyGrid({.resolution_m = navigation.costmap.resolution_m, .width = 1, .height = 1}, kUnknown));
  const std::vector<Eigen::Vector2d> positions = to_positions(route_in_map.stations);
  for (const Eigen::Vector2d& position : positions) costmap.include(position, kMapMargin_m);
  plan::GlobalPlanner planner(navigation.global_planner, seed);
  const plan::TourOrder order = plan::solve_station_order(
      problem_of(route_in_map.stations, lengths_between(positions, costmap, planner), mission), {}, seed);
  if (!order.is_found)
    return {.stations = route_in_map.stations, .text = "No order reaches all stations: given order kept."};

  StationOrder ordered;
  for (const std::size_t index : order.stations) {
    if (index > 0) ordered.stations.push_back(route_in_map.stations[index - 1]);
  }
  ordered.text = fmt::format(
      "Expected duration in this order: {:.0f} s{}; {}.", order.completion,
      order.lateness > 0.0 ? fmt::format(", with an unavoidable delay of {:.0f} s", order.lateness) : "",
      order.is_exact ? "optimal" : fmt::format("the optimum is at most {:.1f} % faster", 100.0 * order.gap()));
  return ordered;
}

}  // namespace patrol::stack
