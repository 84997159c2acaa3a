#include "app/scoring/localizability_map.h"

#include <deque>
#include <set>
#include <utility>

#include "app/scoring/localizability_oracle.h"
#include "app/scoring/world_surfaces.h"
#include "core/error.h"
#include "score/distance_field.h"

namespace patrol::app {
namespace {

constexpr double kClearance_m = 0.4;
constexpr double kLocalizabilityCell_m = 0.05;

}  // namespace

LocalizabilityMap map_localizability(const Scenario& scenario, const ScenarioFiles& files, double step_m) {
  const WorldSurfaces world = world_surfaces(files, kLocalizabilityCell_m);
  LocalizabilityMap map{.surfaces = world.surfaces, .step_m = step_m, .positions = {}};
  const score::DistanceField clearance(score::occupied_cells(map.surfaces));
  const LocalizabilityOracle oracle(*world.world, scenario.sensors.lidar, world.lidar_height_m);
  const Eigen::Vector2d start = files.T_site_start.position();
  const auto place_at = [&](const std::pair<int, int>& node) { return Eigen::Vector2d(start + step_m * Eigen::Vector2d(node.first, node.second)); };
  const auto can_stand = [&](const Eigen::Vector2d& p_world_m) {
    const Cell cell = map.surfaces.geometry().cell_at(p_world_m);
    return map.surfaces.contains(cell) && map.surfaces.at(cell) == kFree && clearance.distance_m(p_world_m) >= kClearance_m;
  };

  std::set<std::pair<int, int>> seen = {{0, 0}};
  for (std::deque<std::pair<int, int>> open = {{0, 0}}; !open.empty(); open.pop_front()) {
    const auto [i, j] = open.front();
    if (!can_stand(place_at({i, j}))) continue;
    map.positions.push_back({.p_world_m = place_at({i, j}), .truth = oracle.at(place_at({i, j}))});
    for (const auto& next : {std::pair(i + 1, j), std::pair(i - 1, j), std::pair(i, j + 1), std::pair(i, j - 1)}) {
      if (seen.insert(next).second) open.push_back(next);
    }
  }
  if (map.positions.empty()) throw InputError("the start lies nearer than 0.4 m to a surface: there is no place to look from");
  return map;
}

}  // namespace patrol::app
