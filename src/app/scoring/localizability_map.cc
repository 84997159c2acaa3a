#include "app/scoring/localizability_map.h"

#include <deque>
#include <set>
#include <utility>

#include "app/scoring/localizability_oracle.h"
#include "app/scoring/mapping_lidar.h"
#include "app/scoring/world_surfaces.h"
#include "core/error.h"
#include "score/distance_field.h"

namespace patrol::app {
namespace {

constexpr double kClearance_m = 0.4;
constexpr double kLocalizabilityCell_m = 0.05;

}  // namespace

LocalizabilityMap map_localizability(const Scenario& scenario, const ScenarioFiles& files, double step_m,
                                     const std::function<void(double)>& on_progress) {
  const WorldSurfaces world = world_surfaces(files, kLocalizabilityCell_m);
  LocalizabilityMap map{.surfaces = world.surfaces, .step_m = step_m, .positions = {}};
  const score::DistanceField clearance(score::occupied_cells(map.surfaces));
  const LocalizabilityOracle oracle(*world.world, scenario.sensors.*mapping_lidar(files.robot).value().settings,
                                    world.lidar_height_m);
  const Eigen::Vector2d start = files.T_site_start.position();
  const auto position_at = [&](const std::pair<int, int>& node) {
    return Eigen::Vector2d(start + step_m * Eigen::Vector2d(node.first, node.second));
  };
  const auto is_reachable = [&](const Eigen::Vector2d& p_world_m) {
    const Cell cell = map.surfaces.geometry().cell_at(p_world_m);
    return map.surfaces.contains(cell) && map.surfaces.at(cell) == kFree &&
           clearance.distance_m(p_world_m) >= kClearance_m;
  };

  std::set<std::pair<int, int>> visited = {{0, 0}};
  for (std::deque<std::pair<int, int>> frontier = {{0, 0}}; !frontier.empty(); frontier.pop_front()) {
    const auto [i, j] = frontier.front();
    if (!is_reachable(position_at({i, j}))) continue;
    map.positions.push_back({.p_world_m = position_at({i, j}), .truth = {}});
    for (const auto& next : {std::pair(i + 1, j), std::pair(i - 1, j), std::pair(i, j + 1), std::pair(i, j - 1)}) {
      if (visited.insert(next).second) frontier.push_back(next);
    }
  }
  if (map.positions.empty()) throw InputError("no reachable positions: start is within 0.4 m of a surface");
  for (std::size_t i = 0; i < map.positions.size(); ++i) {
    map.positions[i].truth = oracle.at(map.positions[i].p_world_m);
    on_progress(static_cast<double>(i + 1) / static_cast<double>(map.positions.size()));
  }
  return map;
}

}  // namespace patrol::app
