#pragma once

#include "core/settings.h"
#include "plan/perception/low_obstacles_settings.h"

namespace patrol::plan {

struct CostmapSettings {
  double resolution_m = 0.1;        ///< side of a cell of the costmap
  double inflation_radius_m = 1.0;  ///< distance of the body's center from an obstacle below which cells have a cost
  double inflation_decay_m = 0.25;  ///< decay length of the inflation cost (to 1/e)
  double safety_margin_m = 0.05;    ///< minimum distance between obstacles and the robot's outline
  double route_margin_m = 0.0;      ///< additional margin of global paths: for disc overhang and control error
  double unknown_cost = 0.15;       ///< cost of an unobserved cell, as a fraction of the highest passable cost
  bool allow_unknown = true;        ///< passability of unknown cells; false for a robot with a complete map
  int occupied_percent = 65;        ///< minimum occupancy of an obstacle cell of the map, percent
  double obstacle_range_m = 8.0;    ///< maximum range of lidar hits that become obstacles of the scan layer
  double obstacle_persistence_s = 8.0;  ///< persistence of an obstacle of the scan layer that is not observed again
  int map_match_tolerance_cells = 0;    ///< largest distance of a hit from a map obstacle to which it belongs (noise)
  /// Minimum distance of a keep-out line from the body's origin in global paths, and from the centers of the discs of
  /// the outline in motions.
  double keep_out_margin_m = 0.2;
  double keep_out_inflation_m = 0.25;  ///< range beyond the margin within which a keep-out line has a cost
  LowObstaclesSettings low = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.02, 0.5));
    visit("inflation_radius_m", self.inflation_radius_m, between(0.05, 3.0));
    visit("inflation_decay_m", self.inflation_decay_m, between(0.01, 3.0));
    visit("safety_margin_m", self.safety_margin_m, between(0.0, 0.5));
    visit("route_margin_m", self.route_margin_m, between(0.0, 0.5));
    visit("unknown_cost", self.unknown_cost, between(0.0, 1.0));
    visit("allow_unknown", self.allow_unknown);
    visit("occupied_percent", self.occupied_percent, between(1, 100));
    visit("obstacle_range_m", self.obstacle_range_m, between(1.0, 30.0));
    visit("obstacle_persistence_s", self.obstacle_persistence_s, between(0.1, 600.0));
    visit("map_match_tolerance_cells", self.map_match_tolerance_cells, between(0, 5));
    visit("keep_out_margin_m", self.keep_out_margin_m, between(0.0, 1.0));
    visit("keep_out_inflation_m", self.keep_out_inflation_m, between(0.0, 2.0));
    visit("low", self.low);
  }
};

}  // namespace patrol::plan
