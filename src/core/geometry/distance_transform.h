#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace patrol {

/// Exact Euclidean distance transform of a binary grid, in squared cells from cell center to cell center.
///
/// The transform is separable [Felzenszwalb12]: two sweeps give the distance along each row, the lower envelope of
/// parabolas along the columns the rest. Up to a cap of cells the envelope is taken by brute force over the 2 cap + 1
/// rows within the cap, whole rows at a time, a handful of vector instructions per eight cells. Without a cap the
/// sweeps run along the columns, and the envelope is built row by row.
class DistanceTransform {
 public:
  /// [row * width + column]; `beyond()` where no obstacle lies within the cap.
  using SquaredDistances = std::vector<std::int16_t>;

  static constexpr int kMaxCap_cells = 100;  ///< sums of two squares fit into 16 bits

  /// `cap_cells`: 1 ... kMaxCap_cells.
  explicit DistanceTransform(int cap_cells);

  int cap_cells() const { return cap_; }
  /// Value of cells without an obstacle within the cap: `cap_cells` squared + 1.
  std::int16_t beyond() const { return static_cast<std::int16_t>(cap_ * cap_ + 1); }

  /// Rectangle of cells of a grid.
  struct Window {
    int col = 0, row = 0;  ///< first column and row
    int width = 0, height = 0;
  };

  /// `is_obstacle` and `result`: width x height, row by row; obstacles are 1, all others 0.
  void compute(const std::vector<std::uint8_t>& is_obstacle, int width, int height, SquaredDistances& result) {
    compute(is_obstacle, width, height, {.width = width, .height = height}, result);
  }
  /// Computes the distances of the cells of `target` only, which is inside the grid. `result`: [row * target.width +
  /// column].
  void compute(const std::vector<std::uint8_t>& is_obstacle, int width, int height, const Window& target,
               SquaredDistances& result);

 private:
  int cap_;
  std::vector<std::int16_t> along_rows_;  ///< squared distance to the nearest obstacle of the same row
  std::vector<std::size_t> rows_;         ///< rows with obstacles, ascending
};

/// Value of `squared_distances` in a grid without obstacles.
inline constexpr double kNoObstacle = 1e20;

/// Distance transform without a cap: squared distances, [row * width + column]. `is_obstacle`: not 0 for obstacles.
std::vector<double> squared_distances(const std::vector<std::uint8_t>& is_obstacle, int width, int height);

/// Squared distances as of `squared_distances` in single precision, with half of the memory.
std::vector<float> squared_distances_float(const std::vector<std::uint8_t>& is_obstacle, int width, int height);

}  // namespace patrol
