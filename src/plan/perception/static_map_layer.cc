#include "plan/perception/static_map_layer.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace patrol::plan {

StaticMapLayer::StaticMapLayer(const CostmapSettings& settings)
    : occupied_percent_(settings.occupied_percent),
      unknown_cost_(settings.allow_unknown ? static_cast<Cost>(std::lround(settings.unknown_cost * kMaxPassableCost))
                                           : kLethalCost) {}

void StaticMapLayer::resize(const CellLattice& lattice) {
  OccupancyGrid map(lattice.geometry, kUnknown);
  for (int row = 0; row < map_.geometry().height; ++row) {
    const std::int8_t* source = &map_.at({0, row});
    std::copy(source, source + map_.geometry().width, &map.at(lattice.to_grid(lattice_.to_lattice({0, row}))));
  }
  map_ = std::move(map);
  lattice_ = lattice;
}

OccupancyGrid StaticMapLayer::pooled(const OccupancyGrid& map) const {
  const GridGeometry& source = map.geometry();
  const GridGeometry& target = lattice_.geometry;
  std::vector<int> col_of(static_cast<std::size_t>(source.width));
  for (int col = 0; col < source.width; ++col) {
    col_of[static_cast<std::size_t>(col)] = target.cell_at(source.center_of({col, 0})).col;
  }
  OccupancyGrid result(target, kUnknown);
  for (int row = 0; row < source.height; ++row) {
    std::int8_t* cells = &result.at({0, target.cell_at(source.center_of({0, row})).row});
    const std::int8_t* values = &map.at({0, row});
    for (std::size_t col = 0; col < col_of.size(); ++col)
      cells[col_of[col]] = std::max(cells[col_of[col]], values[col]);
  }
  return result;
}

CellBox StaticMapLayer::set_map(const OccupancyGrid& map) {
  OccupancyGrid next = pooled(map);
  const int width = lattice_.geometry.width;
  CellBox changed;
  for (int row = 0; row < lattice_.geometry.height; ++row) {
    const std::int8_t* before = &map_.at({0, row});
    const std::int8_t* after = &next.at({0, row});
    const auto [first, unused] = std::mismatch(before, before + width, after);
    if (first == before + width) continue;
    int last = width - 1;
    while (before[last] == after[last]) --last;
    changed.extend({static_cast<int>(first - before), row});
    changed.extend({last, row});
  }
  map_ = std::move(next);
  return changed;
}

bool StaticMapLayer::has_obstacle_near(Cell cell, int radius_cells) const {
  return any_cell_near(cell, radius_cells, [this](Cell near) { return map_.contains(near) && is_obstacle(near); });
}

void StaticMapLayer::mark_obstacles(Cell first, int count, std::uint8_t* is_obstacle) const {
  const std::int8_t* occupancy = &map_.at(first);
  const int occupied_percent = occupied_percent_;
  for (int i = 0; i < count; ++i) is_obstacle[i] |= occupancy[i] >= occupied_percent ? 1 : 0;
}

void StaticMapLayer::raise_costs(Cell first, int count, Cost* cost) const {
  const std::int8_t* occupancy = &map_.at(first);
  const Cost unknown_cost = unknown_cost_;
  for (int i = 0; i < count; ++i) cost[i] = std::max(cost[i], occupancy[i] == kUnknown ? unknown_cost : kFreeCost);
}

}  // namespace patrol::plan
