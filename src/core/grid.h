#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace patrol {

/// Column (along x) and row (along y) of a grid cell.
struct Cell {
  int col = 0;
  int row = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// Placement and size of a grid. Cell (0, 0) has its lower-left corner at `origin_m`; columns grow with x, rows with y.
/// The axes are parallel to those of the frame of the grid.
struct GridGeometry {
  double resolution_m = 0.05;
  int width = 0;   ///< number of columns
  int height = 0;  ///< number of rows
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();

  bool contains(Cell cell) const { return cell.col >= 0 && cell.row >= 0 && cell.col < width && cell.row < height; }
  /// Returns the cell that contains p; it may be outside the grid.
  Cell cell_at(const Eigen::Vector2d& p_m) const {
    return {static_cast<int>(std::floor((p_m.x() - origin_m.x()) / resolution_m)),
            static_cast<int>(std::floor((p_m.y() - origin_m.y()) / resolution_m))};
  }
  Eigen::Vector2d center_of(Cell cell) const {
    return origin_m + resolution_m * Eigen::Vector2d(cell.col + 0.5, cell.row + 0.5);
  }
  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Dense grid of values, stored row by row from low to high y.
template <typename Value>
class Grid {
 public:
  Grid() = default;
  explicit Grid(const GridGeometry& geometry, Value fill = Value{})
      : geometry_(geometry), values_(geometry.size(), fill) {}

  const GridGeometry& geometry() const { return geometry_; }
  bool contains(Cell cell) const { return geometry_.contains(cell); }
  Value& at(Cell cell) { return values_[index(cell)]; }
  const Value& at(Cell cell) const { return values_[index(cell)]; }
  std::vector<Value>& values() { return values_; }
  const std::vector<Value>& values() const { return values_; }

 private:
  std::size_t index(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(geometry_.width) +
           static_cast<std::size_t>(cell.col);
  }

  GridGeometry geometry_;
  std::vector<Value> values_;
};

/// Occupancy in percent as in nav_msgs/OccupancyGrid: -1 unknown, 0 free to 100 occupied.
using OccupancyGrid = Grid<std::int8_t>;

inline constexpr std::int8_t kUnknown = -1;
inline constexpr std::int8_t kFree = 0;
inline constexpr std::int8_t kOccupied = 100;

}  // namespace patrol
