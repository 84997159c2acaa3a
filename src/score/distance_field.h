#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

#include "core/grid.h"

namespace patrol::score {

/// The distance from anywhere to the nearest occupied cell's centre, exact at cell centres and bilinear between them.
class DistanceField {
 public:
  /// Of the cells for which `occupied` is not 0.
  explicit DistanceField(const Grid<std::uint8_t>& occupied);

  /// m; outside the grid, of its nearest cell plus the way to it. +Inf when no cell is occupied.
  double distance_m(const Eigen::Vector2d& p_m) const;

  /// Gradient of `distance_m`; zero when no cell is occupied.
  Eigen::Vector2d gradient(const Eigen::Vector2d& p_m) const;

 private:
  /// Where a point lies among the four cell centres round it.
  struct Place {
    std::array<double, 4> corners;  ///< their distances: lower left, lower right, upper left, upper right
    Eigen::Vector2d fraction;       ///< of the way from the lower left, 0 ... 1
    Eigen::Vector2d way_to_grid;    ///< from the outermost centre, in cells; zero inside
  };
  Place place_of(const Eigen::Vector2d& p_m) const;

  GridGeometry geometry_;
  std::vector<float> distance_m_;  ///< [row * width + column]
  bool is_empty_;                  ///< no cell is occupied
};

/// 1 where the map says occupied (at least 65 percent, as map_server), else 0.
Grid<std::uint8_t> occupied_cells(const OccupancyGrid& map);

}  // namespace patrol::score
