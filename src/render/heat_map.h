#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "render/scene/frame.h"

namespace patrol::render {

/// Scalar value at map positions, drawn as colors under the surfaces of the map.
struct HeatMap {
  struct Sample {
    Eigen::Vector2d p_m;
    double color_fraction = 0.0;  ///< position on the color scale, 0 ... 1
    bool has_stroke = false;
    double stroke_rad = 0.0;  ///< direction of the stroke, in the map's frame
  };
  struct Tick {
    double color_fraction = 0.0;
    std::string text;
  };
  OccupancyGrid surfaces;  ///< map drawn over the colors
  double step_m = 0.5;     ///< distance between positions; each is drawn as a square of this side
  std::vector<Sample> positions;
  std::string title;
  std::string note;
  std::vector<Tick> scale;  ///< labels below the color scale
};

/// Draws the surroundings of the positions, north up, at most `max_width_px` wide, with the color scale below.
Frame draw_heat_map(const HeatMap& map, int max_width_px = 1600);

/// Color scale from dark blue over green to yellow. Lightness increases, so it is readable with color blindness and in
/// gray.
Color heat_color(double color_fraction);

}  // namespace patrol::render
