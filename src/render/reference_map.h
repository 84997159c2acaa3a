#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/grid.h"

namespace patrol::render {

/// Slice of the world to be mapped.
struct ReferenceMapSettings {
  double height_m = 0.4;  ///< height of the slice in world; height of the level robot's lidar
  double resolution_m = 0.025;
  double margin_m = 1.0;  ///< free cells around all objects
  /// Names of the actors that move: mocap bodies, with their limbs ("NAME_..."). Without a value all mocap bodies do.
  std::optional<std::vector<std::string>> actors = std::nullopt;
  /// Positions around which the map is free if no geom intersects the slice. Empty: such a world is refused.
  std::vector<Eigen::Vector2d> visited_m = {};
};

/// Agreement of rendered slice and ray casts about the surfaces.
struct ReferenceMapCheck {
  std::size_t num_checked = 0;   ///< cells that the render or a ray marks as a surface
  std::size_t num_agreeing = 0;  ///< cells marked by both within one cell
  std::size_t num_added = 0;     ///< objects thinner than a cell: found by rays only and added to the map

  double agreement_ratio() const {
    return num_checked == 0 ? 1.0 : static_cast<double>(num_agreeing) / static_cast<double>(num_checked);
  }
};

/// True map of a world with its verification.
struct ReferenceMap {
  OccupancyGrid map;  ///< in world: occupied at surfaces of solid objects, unknown inside, free elsewhere
  ReferenceMapCheck check;
};

/// Reference map: the static geoms of the world that the lidar can hit, cut at one height.
///
/// Two orthographic renders, down and up from the slice, separate inside from outside: a camera whose near plane is
/// inside a closed shape sees the shape's inner side first. A cell is solid when its center is solid. A solid cell is a
/// surface when one of its four neighbors is not solid. Surface cells lie behind the surface by half a cell on average.
/// Rays along the center lines of all rows and columns then check every surface and add objects that are too thin to
/// contain a cell center.
///
/// `view` is a render model (sim/model_assembly.h); the robot and the moving objects are excluded. Throws InputError
/// when no geom intersects the slice and no visited positions are given.
ReferenceMap reference_map(const mjModel& view, const ReferenceMapSettings& settings = {});

}  // namespace patrol::render
