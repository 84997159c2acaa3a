#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/grid.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Observed cells of a submap, coarser than those of its map, with free and surface cells.
class ObservedCells {
 public:
  enum class State : std::uint8_t { kUnknown, kFree, kSurface };

  ObservedCells(const GridMap& map, double cell_m);

  /// State of the cell; unknown outside the grid.
  State at(const Eigen::Vector2d& p_map) const;
  /// Returns whether the cell of p or one of its eight neighbors is a surface.
  bool is_surface_near(const Eigen::Vector2d& p_map) const;

  int num_observed() const { return num_observed_; }
  /// Calls `visit(center)` for every observed cell.
  template <typename Visitor>
  void for_each_observed(Visitor&& visit) const {
    for (int row = 0; row < cells_.geometry().height; ++row) {
      for (int col = 0; col < cells_.geometry().width; ++col) {
        if (cells_.at({col, row}) != State::kUnknown) visit(cells_.geometry().center_of({col, row}));
      }
    }
  }

 private:
  State state(Cell cell) const { return cells_.contains(cell) ? cells_.at(cell) : State::kUnknown; }

  Grid<State> cells_;
  int num_observed_;
};

}  // namespace patrol::slam
