#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/plan/plan_options.h"
#include "core/settings.h"
#include "plan/perception/costmap.h"
#include "plan/perception/footprint.h"
#include "plan/routes/planners.h"
#include "plan/routes/station_order.h"

namespace patrol::app {

/// Settings of `patrol plan --set`. The defaults are those of a point. For a disc, routes.cost_weight is that of the
/// robots (plan/routes/global_planner.h). For a robot, costmap, allow_unknown, routes and speed_mps come from its
/// profile (models/<robot>/<robot>.yaml: stack.navigation).
struct PlanSettings {
  std::string planner = "theta_star";  ///< global planner (`patrol list global_planners`)
  std::uint64_t seed = 1;              ///< seed of stochastic planners and station orders
  bool allow_unknown = false;          ///< passability of unknown cells; false: lethal
  bool smooth = false;
  double min_clearance_m = 0.3;  ///< clearance that smoothing keeps, or the route's if that is smaller; MovingAI: cells
  /// Maximum number of passable cells for the any-angle optimum, which took up to 8 s. The limit for all cells is 8
  /// times as high.
  int max_any_angle_cells = 150'000;
  double speed_mps = 1.0;  ///< speed on a tour; on MovingAI maps cells/s
  plan::CostmapSettings costmap;
  plan::RoutePlannerSettings routes;
  plan::TourOrderSettings tour;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("planner", self.planner, one_of(plan::route_planners()));
    visit("seed", self.seed);
    visit("allow_unknown", self.allow_unknown);
    visit("smooth", self.smooth);
    visit("min_clearance_m", self.min_clearance_m, between(0.0, 5.0));
    visit("max_any_angle_cells", self.max_any_angle_cells, between(0, 100'000'000));
    visit("speed_mps", self.speed_mps, between(0.001, 1000.0));
    visit("costmap", self.costmap);
    visit("routes", self.routes);
    visit("tour", self.tour);
  }
};

/// Body whose path is planned.
struct PlanBody {
  std::string name = "a point";
  std::optional<plan::Footprint> footprint = {};  ///< none for a point
};

struct PlanSetup {
  PlanSettings settings;
  PlanBody body;
};

/// Loads the settings. Throws InputError with the option or the key, also for an unknown planner.
PlanSetup load_plan_setup(const PlanOptions& options);

}  // namespace patrol::app
