#include "importer/site/plan_site.h"

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/map_cells.h"
#include "importer/site/cell_rectangles.h"
#include "io/maps/map_server.h"

namespace patrol::importer {
namespace {

SiteShape wall(std::size_t number, const Eigen::Vector2d& center_m, double yaw_rad, const Eigen::Vector2d& half_m,
               double height_m) {
  return {.name = fmt::format("wall_{}", number),
          .T_site_shape = to_pose3(Pose2{center_m.x(), center_m.y(), yaw_rad}, 0.5 * height_m),
          .size_m = {half_m.x(), half_m.y(), 0.5 * height_m},
          .material = "wall"};
}

/// Throws InputError if there are too many rectangles: the time in which MuJoCo reads a model grows with their square.
void add_cells(const GridGeometry& grid, const std::function<bool(Cell)>& is_selected, const SiteImportOptions& options,
               ImportedSite& site) {
  constexpr std::size_t kMaxRectangles = 60000;
  const std::vector<CellRectangle> parts = rectangles_of(grid, is_selected);
  if (parts.size() > kMaxRectangles)
    throw InputError(fmt::format(
        "{}: the occupied cells form {} rectangles: at most {} are allowed: remove single cells from the plan",
        options.file.string(), parts.size(), kMaxRectangles));
  for (const CellRectangle& part : parts) {
    const Eigen::Vector2d half_m = 0.5 * grid.resolution_m * Eigen::Vector2d(part.width, part.height);
    const Eigen::Vector2d center =
        grid.origin_m + grid.resolution_m * Eigen::Vector2d(part.begin.col, part.begin.row) + half_m;
    site.shapes.push_back(wall(site.shapes.size(), center, 0.0, half_m, options.wall_height_m));
  }
}

ImportedSite empty_site(const OccupancyGrid& plan, const SiteImportOptions& options) {
  constexpr double kMargin_m = 5.0;
  const GridGeometry& grid = plan.geometry();
  ImportedSite site{.name = options.name, .source = options.file.string()};
  site.materials = {{.name = "floor", .rgba = {0.55, 0.55, 0.53, 1.0}},
                    {.name = "wall", .rgba = {0.82, 0.80, 0.76, 1.0}}};
  const Eigen::Vector2d half_m = 0.5 * grid.resolution_m * Eigen::Vector2d(grid.width, grid.height);
  const Eigen::Vector2d middle = grid.origin_m + half_m;
  site.shapes.push_back({.name = "floor",
                         .type = SiteShapeType::kPlane,
                         .T_site_shape = to_pose3(Pose2{middle.x(), middle.y(), 0.0}, 0.0),
                         .size_m = {half_m.x() + kMargin_m, half_m.y() + kMargin_m, 0.0},
                         .material = "floor"});
  site.map = plan;
  site.stack_keys =
      "  # Doors are little wider than a robot.\n"
      "  navigation: {costmap: {resolution_m: 0.05, route_margin_m: 0.02}}\n";
  site.assumptions = {{"floor", "level at height 0, also below unknown cells", ""},
                      {"frame", "the frame of the plan is the frame site", ""}};
  return site;
}

}  // namespace

ImportedSite read_plan_site(const SiteImportOptions& options) {
  if (options.mission.start && options.mission.stations.empty() && options.mission.num_random == 0)
    throw InputError("--start: a floor plan has a start only with --stations or --random-stations");
  const OccupancyGrid plan = io::load_map(options.file);
  ImportedSite site = empty_site(plan, options);
  add_cells(
      plan.geometry(), [&](Cell cell) { return is_occupied(plan.at(cell)); }, options, site);
  if (site.shapes.size() == 1) throw InputError(options.file.string() + ": the plan has no occupied cell");
  site.assumptions.push_back({"walls",
                              fmt::format("occupied cells are solid from the floor to {:g} m", options.wall_height_m),
                              "--wall-height"});
  return site;
}

ImportedSite site_of_walls(const OccupancyGrid& plan, const WallFitter& walls, const SiteImportOptions& options) {
  ImportedSite site = empty_site(plan, options);
  for (const WallSegment& segment : walls.segments()) {
    const Eigen::Vector2d along = segment.end_m - segment.begin_m;
    const Eigen::Vector2d center = 0.5 * (segment.begin_m + segment.end_m) - 0.5 * segment.thickness_m * segment.normal;
    site.shapes.push_back(wall(site.shapes.size(), center, std::atan2(along.y(), along.x()),
                               {0.5 * along.norm(), 0.5 * segment.thickness_m}, options.wall_height_m));
  }
  const std::size_t num_faces = site.shapes.size() - 1;
  add_cells(
      plan.geometry(), [&](Cell cell) { return walls.is_uncovered(cell); }, options, site);
  site.assumptions.push_back(
      {"walls",
       fmt::format(
           "{} straight faces fitted to the hits, up to {:g} cm thick, and {} rectangles of cells with few hits, from "
           "the floor to {:g} m",
           num_faces, 100.0 * WallFitterSettings{}.max_thickness_m, site.shapes.size() - 1 - num_faces,
           options.wall_height_m),
       "--wall-height"});
  return site;
}

}  // namespace patrol::importer
