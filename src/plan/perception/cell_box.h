#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/grid.h"

namespace patrol::plan {

/// Cells from `min` up to and including `max`; empty at first.
struct CellBox {
  Cell min{1, 1};
  Cell max{0, 0};

  bool is_empty() const { return max.col < min.col; }
  int width() const { return max.col - min.col + 1; }
  int height() const { return max.row - min.row + 1; }

  void extend(Cell cell) {
    if (is_empty()) {
      min = max = cell;
      return;
    }
    min = {std::min(min.col, cell.col), std::min(min.row, cell.row)};
    max = {std::max(max.col, cell.col), std::max(max.row, cell.row)};
  }
  void merge(const CellBox& box) {
    if (box.is_empty()) return;
    extend(box.min);
    extend(box.max);
  }

  /// Box with `cells` more on each side, clipped to a grid.
  CellBox grown(int cells, const GridGeometry& within) const {
    return {.min = {std::max(0, min.col - cells), std::max(0, min.row - cells)},
            .max = {std::min(within.width - 1, max.col + cells), std::min(within.height - 1, max.row + cells)}};
  }
};

/// Boxes that cover cells which have changed. Cells far from each other are in different boxes, because each box
/// is updated with its neighborhood.
class CellBoxes {
 public:
  bool is_empty() const { return boxes_.empty(); }
  const std::vector<CellBox>& boxes() const { return boxes_; }

  /// Extends the box that needs the smallest additional area, or begins a box.
  void extend(Cell cell) {
    const CellBox alone{.min = cell, .max = cell};
    long smallest_growth = boxes_.size() < kMaxBoxes ? area(alone) : std::numeric_limits<long>::max();
    CellBox* nearest = nullptr;
    for (CellBox& box : boxes_) {
      CellBox extended = box;
      extended.extend(cell);
      const long growth = area(extended) - area(box);
      if (growth == 0) return;
      if (growth < smallest_growth) smallest_growth = growth, nearest = &box;
    }
    if (nearest) {
      nearest->extend(cell);
    } else {
      boxes_.push_back(alone);
    }
  }
  void merge(const CellBoxes& other) { boxes_.insert(boxes_.end(), other.boxes_.begin(), other.boxes_.end()); }

 private:
  static constexpr long kNeighborhood = 40;  ///< typical width of the neighborhood of a cell, cells
  static constexpr std::size_t kMaxBoxes = 32;

  static long area(const CellBox& box) { return (box.width() + kNeighborhood) * (box.height() + kNeighborhood); }

  std::vector<CellBox> boxes_;
};

/// All cells of a grid.
inline CellBox all_cells(const GridGeometry& geometry) {
  return {.min = {0, 0}, .max = {geometry.width - 1, geometry.height - 1}};
}

}  // namespace patrol::plan
