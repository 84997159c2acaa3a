#include "stack/mission/known_map.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::stack {
namespace {

constexpr double kMaxGoalDistance_m = 1000.0;

/// Returns whether p is inside the map. Computed in real numbers, because the cell index of a distant position
/// overflows.
bool contains(const GridGeometry& map, const Eigen::Vector2d& p_map) {
  const Eigen::Array2d along = p_map - map.origin_m;
  const Eigen::Array2d size = map.resolution_m * Eigen::Array2d(map.width, map.height);
  return (along >= 0.0).all() && (along < size).all();
}

std::string extent_of(const GridGeometry& map) {
  const Eigen::Vector2d end = map.origin_m + map.resolution_m * Eigen::Vector2d(map.width, map.height);
  return fmt::format("x in [{:.2f}, {:.2f}] m, y in [{:.2f}, {:.2f}] m", map.origin_m.x(), end.x(), map.origin_m.y(),
                     end.y());
}

}  // namespace

void validate_map(const std::string& file, const OccupancyGrid& map) {
  const auto has = [&](std::int8_t value) {
    return std::find(map.values().begin(), map.values().end(), value) != map.values().end();
  };
  if (!has(kFree)) throw InputError(file + ": map contains no free cells");
  if (!has(kOccupied)) throw InputError(file + ": map contains no occupied cells");
  if (contains(map.geometry(), Eigen::Vector2d::Zero())) return;
  throw InputError(fmt::format("{}: start (0, 0) is outside the map ({})", file, extent_of(map.geometry())));
}

void validate_goals(const std::string& file, const std::vector<SavedGoal>& goals,
                    const std::optional<OccupancyGrid>& map) {
  for (const SavedGoal& goal : goals) {
    const Eigen::Vector2d p_map = goal.T_map_body.position();
    const std::string prefix =
        fmt::format("{}: goal {}: position {:.6g}, {:.6g} is ", file, goal.number, p_map.x(), p_map.y());
    const auto refuse = [&](const std::string& what) { throw InputError(prefix + what); };
    if (map && !contains(map->geometry(), p_map))
      refuse(fmt::format("outside the map ({})", extent_of(map->geometry())));
    if (!map && p_map.norm() > kMaxGoalDistance_m)
      refuse(fmt::format("more than {} m from the start", kMaxGoalDistance_m));
  }
}

}  // namespace patrol::stack
