#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"

namespace patrol::score {

/// Distance from any point to the center of the nearest occupied cell: exact at cell centers, bilinear between them.
class DistanceField {
 public:
  /// Builds the field of the cells whose value in `occupied` is not 0.
  explicit DistanceField(const Grid<std::uint8_t>& occupied);

  /// Returns the distance in m. Outside the grid it is the distance at the nearest border cell center plus the distance
  /// to that center. +Inf when no cell is occupied.
  double distance_m(const Eigen::Vector2d& p_m) const;

  /// Gradient of `distance_m`, zero when no cell is occupied.
  Eigen::Vector2d gradient(const Eigen::Vector2d& p_m) const;

 private:
  /// Position of a point among the four surrounding cell centers.
  struct GridPosition {
    /// distances at the lower left, lower right, upper left and upper right center, m
    std::array<double, 4> corners;
    Eigen::Vector2d fraction;  ///< fraction of the step from the lower left center along x and y, 0 ... 1
    /// offset of the point from the outermost cell centers, in cells; zero inside the grid
    Eigen::Vector2d offset_to_grid;
  };
  GridPosition grid_position(const Eigen::Vector2d& p_m) const;

  GridGeometry geometry_;
  std::vector<float> distance_m_;  ///< [row * width + column]
  bool is_empty_;                  ///< no cell is occupied
};

/// 1 for cells that the map gives as occupied (at least 65 percent, the threshold of map_server), 0 for all others.
Grid<std::uint8_t> occupied_cells(const OccupancyGrid& map);

}  // namespace patrol::score
