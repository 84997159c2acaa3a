#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "app/plan/plan_map.h"
#include "app/plan/route_picture.h"
#include "app/plan/tour_plan.h"
#include "io/files/table.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

/// Contents of the report on a tour.
struct TourReport {
  const PlanMap& map;
  std::string map_name;
  const PlanSetup& setup;
  const Grid<plan::Cost>& costs;
  Eigen::Vector2d p_from_m;
  std::optional<Eigen::Vector2d> p_end_m;
  const std::vector<TourStop>& stops;
  const TourPlan& tour;
};

/// "start", a station's name, or "end"; `place` as in TourVisit.
std::string node_name(const TourReport& report, std::size_t node);

std::string tour_title(const TourReport& report);
/// Report for standard output: the order with its times.
std::string to_text(const TourReport& report);
/// Report as JSON, with times under `performance`.
io::Metrics to_json(const TourReport& report);
io::Table tour_table(const TourReport& report);
/// Marks of the stations: numbered in the order of the tour, those without a visit by name alone.
std::vector<RoutePicture::Mark> marks_of(const TourReport& report);

}  // namespace patrol::app
