#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"

namespace patrol::plan {

/// Squared distances in cells, from cell centre to cell centre; `cap` squared + 1 where nothing lies within the cap.
using SquaredDistances = std::vector<std::int16_t>;

/// The exact Euclidean distance of every cell of a rectangle to its nearest obstacle, as far as a cap of cells.
///
/// The transform is separable (Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions", 2012): first along
/// rows, then the lower envelope of parabolas along columns. Only distances up to the inflation radius matter here, so
/// the envelope is taken by brute force over the 2 cap + 1 rows in reach: whole rows at a time, a handful of vector
/// instructions per eight cells.
class DistanceTransform {
 public:
  /// `cap_cells` 1 ... 100.
  explicit DistanceTransform(int cap_cells);

  int cap_cells() const { return cap_; }
  /// The value where nothing lies within the cap.
  std::int16_t beyond() const { return static_cast<std::int16_t>(cap_ * cap_ + 1); }

  /// `is_obstacle` and `result`: width x height, row by row.
  void compute(const std::vector<std::uint8_t>& is_obstacle, int width, int height, SquaredDistances& result);

 private:
  void scan_row(const std::uint8_t* is_obstacle, int width, std::int16_t* squared) const;

  int cap_;
  std::vector<std::int16_t> along_rows_;    ///< squared distance to the nearest obstacle of the same row
  std::vector<std::uint8_t> row_is_empty_;
};

}  // namespace patrol::plan
