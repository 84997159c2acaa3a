#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct DepthObstaclesSettings {
  double max_range_m = 1.6;       ///< maximum range of obstacles: beyond, an image row covers too much ground
  double clearing_range_m = 1.3;  ///< maximum range at which observed ground clears a cell
  double min_rise_m = 0.04;       ///< minimum height step of an obstacle; rubble is lower
  double max_slope = 0.32;        ///< maximum drivable slope, rise over run (0.32: 17.7 degrees)
  double max_height_m = 0.8;      ///< maximum height above the ground plane; the lidar sees higher objects
  int ground_search_rows = 8;     ///< rows below a pixel in which its reference ground is searched

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_range_m", self.max_range_m, between(0.3, 10.0));
    visit("clearing_range_m", self.clearing_range_m, between(0.0, 10.0));
    visit("min_rise_m", self.min_rise_m, between(0.01, 0.5));
    visit("max_slope", self.max_slope, between(0.0, 2.0));
    visit("max_height_m", self.max_height_m, between(0.05, 5.0));
    visit("ground_search_rows", self.ground_search_rows, between(1, 100));
  }
};

}  // namespace patrol::plan
