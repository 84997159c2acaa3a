#include "slam/submaps/observed_cells.h"

#include <algorithm>
#include <limits>

namespace patrol::slam {
namespace {

template <typename Visitor>
void for_each_observed_cell(const GridMap& map, Visitor&& visit) {
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        const GridCell cell = tile.at(col, row);
        if (cell.is_observed()) visit(map.center_of({first.col + col, first.row + row}), cell);
      }
    }
  });
}

/// Grid that covers all observed cells; its borders are at multiples of `cell_m`.
GridGeometry geometry_of(const GridMap& map, double cell_m) {
  GridGeometry everywhere{.resolution_m = cell_m};
  constexpr int kMaxIndex = std::numeric_limits<int>::max();
  Cell low{kMaxIndex, kMaxIndex}, high{-kMaxIndex, -kMaxIndex};
  for_each_observed_cell(map, [&](const Eigen::Vector2d& center, const GridCell&) {
    const Cell at = everywhere.cell_at(center);
    low = {std::min(low.col, at.col), std::min(low.row, at.row)};
    high = {std::max(high.col, at.col), std::max(high.row, at.row)};
  });
  if (high.col < low.col) return everywhere;
  return {.resolution_m = cell_m,
          .width = high.col - low.col + 1,
          .height = high.row - low.row + 1,
          .origin_m = cell_m * Eigen::Vector2d(low.col, low.row)};
}

Grid<ObservedCells::State> coarsened(const GridMap& map, double cell_m) {
  using State = ObservedCells::State;
  Grid<State> cells(geometry_of(map, cell_m), State::kUnknown);
  for_each_observed_cell(map, [&](const Eigen::Vector2d& center, const GridCell& cell) {
    State& coarse = cells.at(cells.geometry().cell_at(center));
    coarse = std::max(coarse, cell.is_surface() ? State::kSurface : State::kFree);
  });
  return cells;
}

}  // namespace

ObservedCells::ObservedCells(const GridMap& map, double cell_m)
    : cells_(coarsened(map, cell_m)),
      num_observed_(static_cast<int>(
          std::ranges::count_if(cells_.values(), [](State coarse) { return coarse != State::kUnknown; }))) {}

ObservedCells::State ObservedCells::at(const Eigen::Vector2d& p_map) const {
  return state(cells_.geometry().cell_at(p_map));
}

bool ObservedCells::is_surface_near(const Eigen::Vector2d& p_map) const {
  const Cell at = cells_.geometry().cell_at(p_map);
  for (int row = at.row - 1; row <= at.row + 1; ++row) {
    for (int col = at.col - 1; col <= at.col + 1; ++col) {
      if (state({col, row}) == State::kSurface) return true;
    }
  }
  return false;
}

}  // namespace patrol::slam
