#pragma once

#include <algorithm>
#include <cstddef>

#include "core/grid.h"

namespace patrol::plan {

/// Cells and weights of a bilinear interpolation between cell centers. Outside the grid, the values of the border
/// continue.
class BilinearCell {
 public:
  BilinearCell(const GridGeometry& grid, const Eigen::Vector2d& p) : width_(grid.width) {
    const double col = (p.x() - grid.origin_m.x()) / grid.resolution_m - 0.5;
    const double row = (p.y() - grid.origin_m.y()) / grid.resolution_m - 0.5;
    const int col_floor = floor_to_int(col), row_floor = floor_to_int(row);
    u_ = col - col_floor, v_ = row - row_floor;
    const int left = std::clamp(col_floor, 0, grid.width - 1), low = std::clamp(row_floor, 0, grid.height - 1);
    const int right = std::clamp(col_floor + 1, 0, grid.width - 1);
    const int high = std::clamp(row_floor + 1, 0, grid.height - 1);
    low_left_ = index(left, low), low_right_ = index(right, low);
    high_left_ = index(left, high), high_right_ = index(right, high);
  }

  /// `value_at` takes the index of a cell of the grid.
  template <typename ValueAt>
  double interpolate(const ValueAt& value_at) const {
    return (1.0 - v_) * ((1.0 - u_) * value_at(low_left_) + u_ * value_at(low_right_)) +
           v_ * ((1.0 - u_) * value_at(high_left_) + u_ * value_at(high_right_));
  }

 private:
  /// Values that an int cannot hold are far outside of any grid.
  static int floor_to_int(double value) {
    constexpr double kFar = 1e9;
    const double limited = std::clamp(value, -kFar, kFar);
    const int truncated = static_cast<int>(limited);
    return truncated - (limited < truncated ? 1 : 0);
  }
  std::size_t index(int col, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(col);
  }

  int width_;
  double u_ = 0.0, v_ = 0.0;
  std::size_t low_left_ = 0, low_right_ = 0, high_left_ = 0, high_right_ = 0;
};

}  // namespace patrol::plan
