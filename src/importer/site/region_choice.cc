#include "importer/site/region_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace patrol::importer {

void RegionArea::add(const GridGeometry& plan, Cell cell, double margin_m) {
  // One cell more than the margin: the plan ends at whole cells.
  const int margin = margin_m > 0.0 ? static_cast<int>(std::ceil(margin_m / plan.resolution_m)) + 1 : 0;
  const int border = std::min({cell.col, cell.row, plan.width - 1 - cell.col, plan.height - 1 - cell.row});
  ++num_cells;
  num_inner += border >= margin ? 1 : 0;
  reaches_border |= border == 0;
}

std::optional<RegionChoice> choose_region(const std::vector<RegionArea>& regions,
                                          const std::function<bool(std::size_t)>& is_usable) {
  if (regions.empty()) return std::nullopt;
  std::vector<std::size_t> order(regions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return regions[a].num_cells > regions[b].num_cells; });
  const RegionArea& largest = regions[order.front()];
  const std::size_t min_cells = largest.reaches_border ? largest.num_inner : largest.num_cells;
  for (const std::size_t index : order) {
    if (regions[index].num_cells <= min_cells) break;
    if (!regions[index].reaches_border && is_usable(index)) return RegionChoice{.index = index, .is_enclosed = true};
  }
  return RegionChoice{.index = order.front()};
}

}  // namespace patrol::importer
