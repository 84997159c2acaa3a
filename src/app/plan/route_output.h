#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "app/common/output_directory.h"
#include "app/plan/plan_map.h"
#include "app/plan/plan_settings.h"
#include "app/plan/route_metrics.h"
#include "io/files/table.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

/// Output directory of `patrol plan`: a route, a tour, or a file of problems.
extern const OutputKind kPlanOutput;

/// Contents of the report on one route.
struct RouteReport {
  const PlanMap& map;
  std::string map_name;
  const PlanSetup& setup;
  const Grid<plan::Cost>& costs;
  Eigen::Vector2d p_from_m, p_to_m;  ///< in the grid's frame, as requested
  RouteMetrics metrics;
};

/// "found", "start blocked" ...
const char* status_name(plan::PlanStatus status);

/// Summary line: "tunnel.yaml: 1363 x 233 cells of 0.1 m, 21345 passable, tracked".
std::string grid_text(const std::string& map_name, const PlanMap& map, const Grid<plan::Cost>& costs,
                      const PlanBody& body);

std::string route_title(const RouteReport& report);
/// Report for standard output.
std::string to_text(const RouteReport& report);
/// Report as JSON, with times under `performance`.
io::Metrics to_json(const RouteReport& report);
io::Metrics grid_json(const PlanMap& map, const Grid<plan::Cost>& costs, const PlanBody& body);

/// Table of x, y of each point, in the coordinates of the map, to 1e-6. `points_m`: in the grid's frame.
io::Table route_table(const PlanMap& map, const std::vector<Eigen::Vector2d>& points_m);

}  // namespace patrol::app
