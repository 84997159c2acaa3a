#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/text.h"
#include "importer/site/free_space.h"
#include "importer/site/region_choice.h"
#include "importer/site/site_import.h"
#include "importer/site/site_plan.h"
#include "io/files/tour_stations.h"
#include "sim/mujoco.h"

namespace patrol::importer {
namespace {

constexpr double kStationAccuracy_m = 0.3;

/// Returns the stations of a table; the last one ends the mission. Without a heading, a robot arrives from the station
/// before.
std::vector<Station> stations_of(const std::vector<io::TourStation>& rows, const Pose2& start) {
  std::vector<Station> stations;
  Pose2 last = start;
  for (const io::TourStation& row : rows) {
    const Eigen::Vector2d p(row.x, row.y), moved = p - last.position();
    const double arrival = moved.norm() > 1e-9 ? std::atan2(moved.y(), moved.x()) : last.yaw;
    last = {p.x(), p.y(), row.heading_deg ? to_rad(*row.heading_deg) : arrival};
    stations.push_back({.number = static_cast<int>(stations.size()) + 1,
                        .name = row.name,
                        .type = StationType::kPass,
                        .T_route_body = last,
                        .accuracy_m = kStationAccuracy_m,
                        .priority = row.priority,
                        .earliest_s = row.earliest_s,
                        .latest_s = row.latest_s});
  }
  stations.back().type = StationType::kHome;
  return stations;
}

InputError station_error(const MissionOptions& options, const io::TourStation& row, const std::string& what) {
  return input_error(options.stations.string(), row.line,
                     fmt::format("{}: ({:g}, {:g}): {}", row.name, row.x, row.y, what));
}

/// Reasons for which a mission is not simply on the largest ground (SitePlan).
struct RegionReasons {
  bool is_enclosed = false;
  bool is_too_narrow = false;
};

void add_region_row(const MissionOptions& options, const RegionReasons& reasons, ImportedSite& site) {
  if (reasons.is_enclosed) {
    site.assumptions.push_back(
        {"region",
         fmt::format("inside of walls: the ground outside has no end, and {:g} m of it around the site do not count as "
                     "area",
                     SitePlanSettings{}.margin_m),
         "--start"});
  } else if (reasons.is_too_narrow) {
    site.assumptions.push_back(
        {"region",
         fmt::format("outside of walls: the ground inside has less than {:g} m2 with the clearance of {:.2f} m that {} "
                     "needs",
                     kMinEnclosed_m2, options.clearance_m, options.robot),
         "--start, --robot"});
  }
}

/// Gives a site without a floor plan one: that of the ground at a point, or of `plan_of`. It contains the stations.
/// `ground`: name of the ground at the point.
RegionReasons require_plan(const MissionOptions& options, const std::optional<Eigen::Vector2d>& near,
                           const std::vector<Eigen::Vector2d>& stations_m, const std::string& ground,
                           ImportedSite& site) {
  if (site.map) return {};
  const sim::ModelPtr model = compile_site(site);
  SitePlan plan;
  try {
    plan = plan_of(*model, near, stations_m, {.clearance_m = options.clearance_m});
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", site.source, error.what()));
  }
  site.map = std::move(plan.map);
  const std::string name = near ? ground : plan.is_enclosed ? "largest enclosed" : "largest connected";
  site.assumptions.push_back({"map",
                              fmt::format("floor plan of the {} ground by what lidars see, cells of {:g} m", name,
                                          site.map->geometry().resolution_m),
                              "--start"});
  return {.is_enclosed = plan.is_enclosed, .is_too_narrow = plan.is_too_narrow};
}

/// Refuses a start that the options name and at which the robot cannot stand.
void check_start(const MissionOptions& options, const ImportedSite& site) {
  if (!options.start || options.start_is_recorded) return;
  const Pose2& start = *options.start;
  if (const auto problem = clearance_problem(*site.map, options.clearance_m, start.position()))
    throw InputError(fmt::format("--start {:g},{:g}: {}", start.x, start.y, *problem));
}

/// Start at the first station with its heading, otherwise toward the next one.
Pose2 start_at_first(const std::vector<io::TourStation>& rows) {
  const io::TourStation& first = rows.front();
  double yaw = 0.0;
  if (first.heading_deg) yaw = to_rad(*first.heading_deg);
  else if (rows.size() > 1) yaw = std::atan2(rows[1].y - first.y, rows[1].x - first.x);
  return {first.x, first.y, yaw};
}

/// Reports stations to which the robot does not fit through the passages of the floor plan.
void add_passage_row(const MissionOptions& options, const std::vector<io::TourStation>& rows, const Pose2& start,
                     ImportedSite& site) {
  const FreeSpace passable(*site.map, options.half_width_m, start.position());
  std::vector<std::string> behind;
  for (const io::TourStation& row : rows) {
    if (!passable.contains({row.x, row.y})) behind.push_back(row.name);
  }
  if (behind.empty()) return;
  site.assumptions.push_back(
      {"passages",
       fmt::format("{} of {} stations are behind passages narrower than {:.2f} m, the width of "
                   "the robot: {}",
                   behind.size(), rows.size(), 2.0 * options.half_width_m, patrol::join(behind, ", ")),
       "--robot, --stations"});
}

void add_table_mission(const MissionOptions& options, ImportedSite& site) {
  const std::vector<io::TourStation> rows = io::load_tour_stations(options.stations);
  const Pose2 start = options.start ? *options.start : start_at_first(rows);
  std::vector<Eigen::Vector2d> stations_m;
  for (const io::TourStation& row : rows) stations_m.emplace_back(row.x, row.y);
  try {
    require_plan(options, start.position(), stations_m, options.start ? "start's" : "first station's", site);
  } catch (const InputError& error) {
    if (options.start) throw;
    throw station_error(options, rows.front(), error.what());
  }
  check_start(options, site);
  const FreeSpace connected(*site.map, 0.5 * site.map->geometry().resolution_m, start.position());
  for (const io::TourStation& row : rows) {
    const Eigen::Vector2d p(row.x, row.y);
    if (const auto problem = clearance_problem(*site.map, options.clearance_m, p))
      throw station_error(options, row, *problem);
    if (!connected.contains(p))
      throw station_error(options, row, "not connected to the start by free ground of the floor plan");
  }
  add_passage_row(options, rows, start, site);
  if (!options.start)
    site.assumptions.push_back(
        {"start",
         fmt::format("at the first station, ({:.2f}, {:.2f}), heading {:.0f}", start.x, start.y, to_deg(start.yaw)),
         "--start"});
  site.T_site_start = start;
  site.route = Route{.stations = stations_of(rows, start)};
}

FreeSpace free_space_of(const MissionOptions& options, const std::optional<Eigen::Vector2d>& near, double margin_m,
                        const ImportedSite& site) {
  try {
    return {*site.map, options.clearance_m, near, margin_m};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}; the site needs a floor of that size", site.source, error.what()));
  }
}

void add_random_mission(const MissionOptions& options, ImportedSite& site) {
  const std::optional<Eigen::Vector2d> near = options.start ? std::optional(options.start->position()) : std::nullopt;
  const double margin_m = site.map ? 0.0 : SitePlanSettings{}.margin_m;
  RegionReasons reasons = require_plan(options, near, {}, "start's", site);
  check_start(options, site);
  const FreeSpace space = free_space_of(options, near, margin_m, site);
  reasons.is_enclosed |= space.is_enclosed();
  add_region_row(options, reasons, site);
  if (options.start) {
    site.T_site_start = *options.start;
  } else {  // the first random station
    const std::vector<Station> first = random_stations(space, {}, 1, options.seed);
    site.T_site_start = {first[0].T_route_body.x, first[0].T_route_body.y, 0.0};
    site.assumptions.push_back(
        {"start", fmt::format("drawn at ({:.2f}, {:.2f}), heading 0", site.T_site_start.x, site.T_site_start.y),
         "--start"});
  }
  site.route = Route{.stations = random_stations(space, site.T_site_start, options.num_random, options.seed)};
}

/// Checks a start of a site that has neither stations nor a floor plan.
void check_start_without_mission(const MissionOptions& options, ImportedSite& site) {
  const sim::ModelPtr model = compile_site(site);
  try {
    refuse_start_in_solid(*model, options.start->position());
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", site.source, error.what()));
  }
  site.assumptions.push_back({"start", "chooses the ground of meshes only: without stations, the site has no mission",
                              "--stations or --random-stations"});
}

}  // namespace

void add_mission(const MissionOptions& options, ImportedSite& site) {
  site.robot = options.robot;
  site.lidar_height_m = options.lidar_height_m;
  if (!options.stations.empty() && options.num_random > 0)
    throw InputError("--stations and --random-stations are mutually exclusive: only one of them is allowed");
  if (!options.stations.empty()) add_table_mission(options, site);
  else if (options.num_random > 0) add_random_mission(options, site);
  else if (options.start && !site.map) check_start_without_mission(options, site);
}

}  // namespace patrol::importer
