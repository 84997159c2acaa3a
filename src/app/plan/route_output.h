#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "app/output_directory.h"
#include "app/plan/plan_map.h"
#include "app/plan/plan_settings.h"
#include "app/plan/route_figures.h"
#include "io/metrics_json.h"
#include "io/table.h"

namespace patrol::app {

/// What `patrol plan` leaves: of a route, of a tour, or of a file of problems.
extern const OutputKind kPlanOutput;

/// Everything about one route that is printed and written.
struct RouteReport {
  const PlanMap& map;
  std::string map_name;
  const PlanSetup& setup;
  const Grid<plan::Cost>& costs;
  Eigen::Vector2d p_from_m, p_to_m;  ///< in the grid's frame, as asked for
  RouteFigures figures;
};

/// "found", "start blocked" ...
const char* status_name(plan::PlanStatus status);

/// "tunnel.yaml: 1363 x 233 cells of 0.1 m, 21345 passable, tracked".
std::string grid_text(const std::string& map_name, const PlanMap& map, const Grid<plan::Cost>& costs, const PlanBody& body);

std::string route_title(const RouteReport& report);
/// The block for standard output.
std::string to_text(const RouteReport& report);
/// The same figures, those of the clock under `performance`.
io::Metrics to_json(const RouteReport& report);
io::Metrics grid_json(const PlanMap& map, const Grid<plan::Cost>& costs, const PlanBody& body);

/// x, y of each point, as the map names places, to 1e-6. `points_m` in the grid's frame.
io::Table route_table(const PlanMap& map, const std::vector<Eigen::Vector2d>& points_m);

}  // namespace patrol::app
