#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "importer/site/free_space.h"
#include "importer/site/site_import.h"
#include "importer/site/site_plan.h"
#include "io/files/tour_stations.h"

namespace patrol::importer {
namespace {

constexpr double kStationAccuracy_m = 0.3;

/// Returns the stations of a table; the last one ends the mission. Without a heading, a robot arrives from the station
/// before.
std::vector<Station> stations_of_table(const std::filesystem::path& file, const Pose2& start) {
  std::vector<Station> stations;
  Eigen::Vector2d last = start.position();
  for (const io::TourStation& row : io::load_tour_stations(file)) {
    const Eigen::Vector2d p(row.x, row.y), moved = p - last;
    stations.push_back(
        {.number = static_cast<int>(stations.size()) + 1,
         .name = row.name,
         .type = StationType::kPass,
         .T_route_body = {p.x(), p.y(), row.heading_deg ? to_rad(*row.heading_deg) : std::atan2(moved.y(), moved.x())},
         .accuracy_m = kStationAccuracy_m,
         .priority = row.priority,
         .earliest_s = row.earliest_s,
         .latest_s = row.latest_s});
    last = p;
  }
  stations.back().type = StationType::kHome;
  return stations;
}

}  // namespace

void add_mission(const MissionOptions& options, ImportedSite& site) {
  site.robot = options.robot;
  if (!options.stations.empty() && options.num_random > 0)
    throw InputError("--stations and --random-stations are mutually exclusive: only one of them is allowed");
  if (!options.stations.empty()) {
    if (options.start) site.T_site_start = *options.start;
    site.route = Route{.stations = stations_of_table(options.stations, site.T_site_start)};
  } else if (options.num_random > 0) {
    const std::optional<Eigen::Vector2d> near = options.start ? std::optional(options.start->position()) : std::nullopt;
    if (!site.map) {
      site.map = plan_of(*compile_site(site), near);
      site.assumptions.push_back(
          {"map",
           fmt::format("floor plan of the {} ground by what lidars see, cells of {:g} m",
                       near ? "start's" : "largest connected", site.map->geometry().resolution_m),
           "--start"});
    }
    const FreeSpace space(*site.map, options.clearance_m, near);
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
}

}  // namespace patrol::importer
