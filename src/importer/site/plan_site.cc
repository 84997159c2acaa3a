#include "importer/site/plan_site.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "importer/site/cell_rectangles.h"
#include "io/maps/map_server.h"

namespace patrol::importer {
namespace {

constexpr int kOccupied_percent = 65;  // as map_server: from this occupancy on a cell is a wall

}  // namespace

ImportedSite read_plan_site(const SiteImportOptions& options) {
  return site_of_plan(io::load_map(options.file), options.file.filename().string(), options);
}

ImportedSite site_of_plan(const OccupancyGrid& plan, const std::string& source, const SiteImportOptions& options) {
  const GridGeometry& grid = plan.geometry();
  const std::vector<CellRectangle> walls =
      rectangles_of(grid, [&](Cell cell) { return plan.at(cell) >= kOccupied_percent; });
  if (walls.empty()) throw InputError(options.file.string() + ": the plan has no occupied cell");
  ImportedSite site{.name = options.name, .source = source};
  site.materials = {{.name = "wall", .rgba = {0.82, 0.80, 0.76, 1.0}},
                    {.name = "floor", .rgba = {0.55, 0.55, 0.53, 1.0}}};
  const Eigen::Vector2d half_m = 0.5 * grid.resolution_m * Eigen::Vector2d(grid.width, grid.height);
  const Eigen::Vector2d middle = grid.origin_m + half_m;
  site.shapes.push_back({.name = "floor",
                         .type = SiteShapeType::kPlane,
                         .T_site_shape = {{middle.x(), middle.y(), 0.0}, Eigen::Quaterniond::Identity()},
                         .size_m = {half_m.x() + 5.0, half_m.y() + 5.0, 0.0},
                         .material = "floor"});
  for (const CellRectangle& wall : walls) {
    const Eigen::Vector2d size_m = grid.resolution_m * Eigen::Vector2d(wall.width, wall.height);
    const Eigen::Vector2d center =
        grid.origin_m + grid.resolution_m * Eigen::Vector2d(wall.begin.col, wall.begin.row) + 0.5 * size_m;
    site.shapes.push_back(
        {.name = fmt::format("wall_{}", site.shapes.size()),
         .T_site_shape = {{center.x(), center.y(), 0.5 * options.wall_height_m}, Eigen::Quaterniond::Identity()},
         .size_m = {0.5 * size_m.x(), 0.5 * size_m.y(), 0.5 * options.wall_height_m},
         .material = "wall"});
  }
  site.map = plan;
  site.assumptions = {{"walls", fmt::format("occupied cells are solid from the floor to {:g} m", options.wall_height_m),
                       "--wall-height"},
                      {"floor", "level at height 0, also below unknown cells", ""},
                      {"frame", "the frame of the plan is the frame site", ""}};
  return site;
}

}  // namespace patrol::importer
