#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "plan/perception/costmap.h"
#include "render/scene/frame.h"

namespace patrol::app {

/// Picture of a route on its map.
struct RoutePicture {
  struct Mark {
    Eigen::Vector2d p_m;
    std::string text;
    Color color;
  };
  const OccupancyGrid& occupancy;
  const Grid<plan::Cost>& costs;        ///< in the frame of `occupancy`
  std::vector<Eigen::Vector2d> line_m;  ///< empty without a route
  std::vector<Mark> marks;
  std::string title, note;
};

inline constexpr Color kStartColor{0, 128, 96}, kGoalColor{196, 40, 32}, kStopColor{92, 48, 150};

/// Renders the known part of the map, y up, at most 1600 x 1000 pixels: obstacles dark, inflated lethal and costly
/// cells shaded. Throws InputError if no font is found.
render::Frame draw_route(const RoutePicture& picture);

}  // namespace patrol::app
