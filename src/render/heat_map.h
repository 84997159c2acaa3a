#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "render/frame.h"

namespace patrol::render {

/// A figure of places, drawn as colours over the surfaces between which they lie.
struct HeatMap {
  struct Place {
    Eigen::Vector2d p_m;
    double share = 0.0;            ///< 0 ... 1 of the scale's colours
    bool has_stroke = false;
    double stroke_rad = 0.0;       ///< a direction to be shown there, in the map's frame
  };
  struct Tick {
    double share = 0.0;
    std::string text;
  };
  OccupancyGrid surfaces;
  double step_m = 0.5;             ///< from place to place: each is a square so wide
  std::vector<Place> places;
  std::string title;
  std::string note;
  std::vector<Tick> scale;         ///< written below the colours
};

/// The places' surroundings, north up, at most `max_width_px` wide, the scale below.
Frame draw_heat_map(const HeatMap& map, int max_width_px = 1600);

/// Dark blue, green, yellow: growing lightness, told apart by the colour-blind and in grey.
Color heat_color(double share);

}  // namespace patrol::render
