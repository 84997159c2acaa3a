#pragma once

#include <cstddef>

#include <mujoco/mujoco.h>

#include "core/grid.h"

namespace patrol::render {

struct ReferenceMapSettings {
  double height_m = 0.4;  ///< of the slice, in world: where the level robot's lidar looks
  double resolution_m = 0.025;
  double margin_m = 1.0;  ///< free cells around everything
};

/// How well two ways of looking at the slice agree about where its surfaces are.
struct ReferenceMapCheck {
  std::size_t cells_checked = 0;   ///< cells that the render or a ray calls a surface
  std::size_t cells_agreeing = 0;  ///< of these, cells that both find, within one cell
  std::size_t cells_added = 0;     ///< thinner than a cell: met by rays only, and put into the map

  double share_agreeing() const {
    return cells_checked == 0 ? 1.0
                              : static_cast<double>(cells_agreeing) / static_cast<double>(cells_checked);
  }
};

struct ReferenceMap {
  OccupancyGrid
      map;  ///< in world: occupied where a solid thing's surface is, unknown inside it, free elsewhere
  ReferenceMapCheck check;
};

/// The true map: what stands still in the world and can be hit by the lidar, cut at one height.
///
/// Two orthographic renders, down and up from the slice, tell inside from outside: a camera that has its near
/// plane inside a closed shape sees the inner side of it first. A cell is solid when its centre is, and a
/// surface when one of its four neighbours is not solid: surface cells lie behind the surface by half a cell
/// on average. Rays along the centre lines of all rows and columns then check every surface, and add what is
/// too thin to hold a cell's centre.
///
/// `view` is a model for renders (sim/model_assembly.h); the robot and everything that moves are left out.
/// Throws InputError when nothing stands at that height.
ReferenceMap reference_map(const mjModel& view, const ReferenceMapSettings& settings = {});

}  // namespace patrol::render
