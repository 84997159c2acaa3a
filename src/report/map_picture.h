#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/color.h"
#include "core/frames.h"
#include "core/grid.h"

namespace patrol::report {

/// Map as pictures, north up, in world axes.
struct MapPicture {
  /// Picture with the upper left corner of the map.
  struct Sheet {
    std::string png;
    Eigen::Vector2d size_m = Eigen::Vector2d::Zero();
  };
  Sheet overview;  ///< coarse with thick walls, for the view of the whole map
  Sheet detail;    ///< one pixel per cell
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero(), high_m = Eigen::Vector2d::Zero();  ///< corners in world
  bool has_errors = false;
};

/// Built map and true map for a comparison.
struct MapLayers {
  OccupancyGrid built;  ///< in map
  Pose2 T_world_map;
  std::optional<OccupancyGrid> truth;  ///< in world
  Grid<float> error_m;  ///< distance of each occupied cell of `built` to the nearest true surface; empty if unknown
};

/// Draws the occupied cells in the color of their error, above the true surfaces and the free cells. `shown` (in world)
/// is the minimum area of the pictures. A pixel of the detail picture has the size of a cell of the built map, or more
/// to limit the picture to 8 million pixels.
MapPicture map_picture(const MapLayers& layers, Eigen::AlignedBox2d shown);

/// Colors of errors from 0 to `kMapErrorEnd_m`. Larger errors have the last color.
inline constexpr double kMapErrorEnd_m = 0.20;
Color map_error_color(double error_m);

inline constexpr Color kMapFree{244, 245, 246};
inline constexpr Color kMapTruth{172, 182, 192};

}  // namespace patrol::report
