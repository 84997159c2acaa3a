#pragma once

#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "render/frame.h"

namespace patrol::render {

/// A map as pictures: north up, axes of world.
struct MapPicture {
  /// Its upper left corner is that of the map.
  struct Sheet {
    std::string png;
    Eigen::Vector2d size_m = Eigen::Vector2d::Zero();
  };
  Sheet overview;  ///< coarse, walls drawn broad: for the whole map at once
  Sheet detail;    ///< cell by cell
  Eigen::Vector2d low_m = Eigen::Vector2d::Zero(), high_m = Eigen::Vector2d::Zero();  ///< corners, in world
  bool has_errors = false;
};

/// A built map laid over the true one.
struct MapLayers {
  OccupancyGrid built;  ///< in map
  Pose2 T_world_map;
  std::optional<OccupancyGrid> truth;  ///< in world
  Grid<float> error_m;  ///< of `built`'s occupied cells, from their centre to the nearest true surface; empty: not known
};

/// Occupied cells in the colour of their error, true surfaces below them, what is known to be free below both. `shown` (in world) is
/// the least that the pictures show. The detail's pixels are as large as the built map's cells, or larger, so that there are 8 million
/// at most.
MapPicture map_picture(const MapLayers& layers, Eigen::AlignedBox2d shown);

/// The colours of errors from 0 to `kMapErrorEnd_m`; larger ones have the last.
inline constexpr double kMapErrorEnd_m = 0.20;
Color map_error_color(double error_m);

inline constexpr Color kMapFree{244, 245, 246};
inline constexpr Color kMapTruth{172, 182, 192};

}  // namespace patrol::render
