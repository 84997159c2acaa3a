#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "core/grid.h"
#include "plan/perception/costmap.h"
#include "render/frame.h"

namespace patrol::app {

/// A route on its map.
struct RoutePicture {
  struct Mark {
    Eigen::Vector2d p_m;
    std::string text;
    render::Color color;
  };
  const OccupancyGrid& occupancy;
  const Grid<plan::Cost>& costs;  ///< in the same frame
  std::vector<Eigen::Vector2d> line_m;  ///< none: no route
  std::vector<Mark> marks;
  std::string title, note;
};

inline constexpr render::Color kStartColor{0, 128, 96}, kGoalColor{196, 40, 32}, kStopColor{92, 48, 150};

/// What is known of the map, y up, at most 1600 x 1000 pixels: obstacles dark, what inflation makes lethal and what it makes dearer shaded. Throws
/// InputError when there is no font.
render::Frame draw_route(const RoutePicture& picture);

}  // namespace patrol::app
