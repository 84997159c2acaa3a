#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/plan/plan_options.h"
#include "core/settings.h"
#include "plan/costmap.h"
#include "plan/footprint.h"
#include "plan/routes/planners.h"
#include "plan/routes/tour_order.h"

namespace patrol::app {

/// Everything that `patrol plan --set` reaches. Defaults are a point's; for a disc routes.cost_weight is the robots' (plan/global_planner.h); for a robot
/// costmap, unknown, routes and speed_mps are those that it drives with (models/<robot>/<robot>.yaml: stack.plan).
struct PlanSettings {
  std::string planner = "theta_star";  ///< plan/routes/planners.h
  std::uint64_t seed = 1;              ///< of planners and tour orders that draw
  std::string unknown = "lethal";      ///< or "free": what the map does not know may be crossed, by a disc or a robot at costmap.unknown_cost
  bool smooth = false;
  double kept_clearance_m = 0.3;       ///< as far as this, smoothing brings a route no nearer to what is lethal; on MovingAI maps cells
  int any_angle_most_cells = 150'000;  ///< with more passable ones, or 8 times as many in all, the any-angle optimum is not looked for: it took up to 8 s
  double speed_mps = 1.0;              ///< on a tour; on MovingAI maps cells a second
  plan::CostmapSettings costmap;
  plan::RoutePlannerSettings routes;
  plan::TourOrderSettings tour;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("planner", self.planner, one_of(plan::route_planners()));
    visit("seed", self.seed);
    visit("unknown", self.unknown, one_of({"lethal", "free"}));
    visit("smooth", self.smooth);
    visit("kept_clearance_m", self.kept_clearance_m, between(0.0, 5.0));
    visit("any_angle_most_cells", self.any_angle_most_cells, between(0, 100'000'000));
    visit("speed_mps", self.speed_mps, between(0.001, 1000.0));
    visit("costmap", self.costmap);
    visit("routes", self.routes);
    visit("tour", self.tour);
  }
};

/// What is to find its way.
struct PlanBody {
  std::string name = "a point";
  std::optional<plan::Footprint> footprint = {};  ///< none: a point
};

struct PlanSetup {
  PlanSettings settings;
  PlanBody body;
};

/// Throws InputError that names the option or the key, for an unknown planner too.
PlanSetup load_plan_setup(const PlanOptions& options);

}  // namespace patrol::app
