#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/grid.h"

namespace patrol::importer {

/// Smallest ground inside of walls for a mission, m2 with the clearance of the robot.
inline constexpr double kMinEnclosed_m2 = 1.0;

/// Number of cells of a connected region of a floor plan.
struct RegionArea {
  std::size_t num_cells = 0;
  std::size_t num_inner = 0;    ///< cells that are not in the margin along the border of the plan
  bool reaches_border = false;  ///< whether the region reaches the border of the plan

  /// Adds a cell of the region. `margin_m`: width of the margin; 0: none.
  void add(const GridGeometry& plan, Cell cell, double margin_m);
};

/// Region of a mission without a start.
struct RegionChoice {
  std::size_t index = 0;
  bool is_enclosed = false;  ///< whether the region is inside of walls, although a region with its margin is larger
};

/// Returns the largest region; none if there are no regions. If it reaches the border of the plan, its ground has no
/// end there, and the cells in its margin do not count as area. Then it is the largest region inside of the border that
/// has more cells than the largest has without the margin, if `is_usable(index)`.
std::optional<RegionChoice> choose_region(const std::vector<RegionArea>& regions,
                                          const std::function<bool(std::size_t)>& is_usable);

}  // namespace patrol::importer
