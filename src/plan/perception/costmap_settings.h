#pragma once

#include "core/settings.h"
#include "plan/perception/low_obstacles.h"

namespace patrol::plan {

struct CostmapSettings {
  double resolution_m = 0.1;
  double inflation_radius_m = 1.0;      ///< obstacles nearer than this to the body's centre cost something
  double inflation_decay_m = 0.25;      ///< over this distance the cost falls to 1/e
  double safety_margin_m = 0.05;        ///< kept from the robot's outline
  double route_margin_m = 0.0;          ///< kept by routes beyond that: the discs stick out, and a robot must be steered
  double unknown_cost = 0.15;           ///< of a cell nobody has seen, as a fraction of the highest passable cost
  bool crosses_unknown = true;          ///< false: what the map does not know is no way; for a robot whose map is complete
  int occupied_percent = 65;            ///< map cells from here on are obstacles
  double obstacle_range_m = 8.0;        ///< live hits nearer than this are obstacles before the map knows them
  double obstacle_memory_s = 8.0;       ///< how long a live obstacle is believed without being seen again
  int map_slack_cells = 0;              ///< a hit this near to an obstacle of the map is that: noise makes no wall thicker
  double keep_out_margin_m = 0.2;       ///< between a keep-out line and the axis of the body
  double keep_out_inflation_m = 0.25;   ///< beyond the margin, where nearness to a line costs something
  LowObstaclesSettings low = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.02, 0.5));
    visit("inflation_radius_m", self.inflation_radius_m, between(0.05, 3.0));
    visit("inflation_decay_m", self.inflation_decay_m, between(0.01, 3.0));
    visit("safety_margin_m", self.safety_margin_m, between(0.0, 0.5));
    visit("route_margin_m", self.route_margin_m, between(0.0, 0.5));
    visit("unknown_cost", self.unknown_cost, between(0.0, 1.0));
    visit("crosses_unknown", self.crosses_unknown);
    visit("occupied_percent", self.occupied_percent, between(1, 100));
    visit("obstacle_range_m", self.obstacle_range_m, between(1.0, 30.0));
    visit("obstacle_memory_s", self.obstacle_memory_s, between(0.1, 600.0));
    visit("map_slack_cells", self.map_slack_cells, between(0, 5));
    visit("keep_out_margin_m", self.keep_out_margin_m, between(0.0, 1.0));
    visit("keep_out_inflation_m", self.keep_out_inflation_m, between(0.0, 2.0));
    visit("low", self.low);
  }
};

}  // namespace patrol::plan
