#include "importer/site/course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/distance_transform.h"
#include "core/random.h"

namespace patrol::importer {
namespace {

constexpr double kArrival_m = 1.0;   // distance from the goal at which the benchmark ends
constexpr double kWallHalf_m = 0.1;  // half thickness of the walls at the sides
constexpr double kHeight_m = 1.0;    // of cylinders and walls, times the scale

Grid<std::uint8_t> smoothed(const Grid<std::uint8_t>& field) {
  Grid<std::uint8_t> next = field;
  const GridGeometry& grid = field.geometry();
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      int neighbors = 0;
      for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
          if ((r != row || c != col) && grid.contains({c, r})) neighbors += field.at({c, r});
        }
      }
      if (neighbors >= 5) next.at({col, row}) = 1;
      else if (neighbors <= 1) next.at({col, row}) = 0;
    }
  }
  return next;
}

/// Cells that the center of the disk may occupy, on a finer grid over the whole course.
Grid<std::uint8_t> open_cells(const Course& course, const CourseSettings& settings) {
  constexpr int kFiner = 3;
  const GridGeometry& field = course.field.geometry();
  const double cell_m = field.resolution_m / kFiner, half_m = 0.5 * field.resolution_m * field.height;
  const double radius_m = settings.scale * settings.passage_radius_m;
  GridGeometry grid{.resolution_m = cell_m,
                    .width = static_cast<int>(std::ceil(course.goal_m.x() / cell_m)) + 2 * kFiner,
                    .height = field.height * kFiner,
                    .origin_m = {-kFiner * cell_m, -half_m}};
  // One more row at each side for the walls.
  grid.height += 2;
  grid.origin_m.y() -= cell_m;
  std::vector<std::uint8_t> is_obstacle(grid.size());
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      const Eigen::Vector2d p = grid.center_of({col, row});
      const Cell cell = field.cell_at(p);
      const bool is_wall = row == 0 || row == grid.height - 1;
      const bool is_cylinder = field.contains(cell) && course.field.at(cell) != 0 &&
                               (p - field.center_of(cell)).norm() <= settings.scale * settings.radius_m;
      is_obstacle[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.width) +
                  static_cast<std::size_t>(col)] = is_wall || is_cylinder ? 1 : 0;
    }
  }
  const std::vector<double> squared = squared_distances(is_obstacle, grid.width, grid.height);
  Grid<std::uint8_t> open(grid);
  const double min_cells = radius_m / cell_m;
  for (std::size_t i = 0; i < squared.size(); ++i) open.values()[i] = squared[i] >= min_cells * min_cells ? 1 : 0;
  return open;
}

/// Length of the shortest path over eight neighbors; infinite if there is none.
double shortest_path_m(const Grid<std::uint8_t>& open, const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) {
  struct Entry {
    double length;
    Cell cell;
    bool operator>(const Entry& other) const { return length > other.length; }
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const GridGeometry& grid = open.geometry();
  Grid<double> length(grid, kInfinite);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  const Cell start = grid.cell_at(from_m), goal = grid.cell_at(to_m);
  if (open.at(start) == 0 || open.at(goal) == 0) return kInfinite;
  front.push({0.0, start});
  length.at(start) = 0.0;
  while (!front.empty()) {
    const Entry entry = front.top();
    front.pop();
    if (entry.cell == goal) return entry.length * grid.resolution_m;
    if (entry.length > length.at(entry.cell)) continue;
    for (int dr = -1; dr <= 1; ++dr) {
      for (int dc = -1; dc <= 1; ++dc) {
        const Cell next{entry.cell.col + dc, entry.cell.row + dr};
        if ((dr == 0 && dc == 0) || !grid.contains(next) || open.at(next) == 0) continue;
        const double to_next = entry.length + std::hypot(dr, dc);
        if (to_next >= length.at(next)) continue;
        length.at(next) = to_next;
        front.push({to_next, next});
      }
    }
  }
  return kInfinite;
}

}  // namespace

Course draw_course(std::uint64_t number, const CourseSettings& settings) {
  constexpr std::array kFills = {0.15, 0.20, 0.25, 0.30};
  constexpr int kFewestSteps = 2, kStepChoices = 3;
  constexpr std::uint64_t kDraws = 1000;
  const double cell_m = 2.0 * settings.scale * settings.radius_m, width_m = cell_m * settings.cells;
  const double begin_m = settings.scale * settings.run_in_m;
  const RandomStream stream(number, "course");
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    Course course{.field = Grid<std::uint8_t>({.resolution_m = cell_m,
                                               .width = settings.cells,
                                               .height = settings.cells,
                                               .origin_m = {begin_m, -0.5 * width_m}}),
                  .goal_m = {begin_m + width_m + settings.scale * settings.run_out_m, 0.0}};
    const auto choice = stream.uniforms(draw, 0);
    course.fill = kFills[static_cast<std::size_t>(choice[0] * kFills.size())];
    course.smoothing_steps = kFewestSteps + static_cast<int>(choice[1] * kStepChoices);
    std::uint64_t index = 1;
    for (std::uint8_t& cell : course.field.values()) cell = stream.uniform(draw, index++) < course.fill ? 1 : 0;
    for (int step = 0; step < course.smoothing_steps; ++step) course.field = smoothed(course.field);
    course.path_length_m = shortest_path_m(open_cells(course, settings), {0.0, 0.0}, course.goal_m);
    if (!std::isfinite(course.path_length_m)) continue;
    course.optimal_time_s = course.path_length_m / settings.max_speed_mps;
    return course;
  }
  throw std::runtime_error("course: no draw has a path");
}

ImportedSite site_of_course(const Course& course, const CourseSettings& settings, const std::string& name,
                            const std::string& robot) {
  ImportedSite site{.name = name, .source = "a generated course"};
  site.materials = {{.name = "floor", .rgba = {0.55, 0.55, 0.53, 1.0}},
                    {.name = "cylinder", .rgba = {0.75, 0.75, 0.75, 1.0}},
                    {.name = "wall", .rgba = {0.82, 0.80, 0.76, 1.0}}};
  const GridGeometry& grid = course.field.geometry();
  const double half_height_m = 0.5 * kHeight_m * settings.scale, behind_m = settings.scale * settings.run_in_m;
  const double half_width_m = 0.5 * grid.resolution_m * grid.height;
  const double half_length_m = 0.5 * (course.goal_m.x() + 2.0 * behind_m), middle_m = 0.5 * course.goal_m.x();
  site.shapes.push_back({.name = "floor",
                         .type = SiteShapeType::kPlane,
                         .T_site_shape = to_pose3(Pose2{middle_m, 0.0, 0.0}, 0.0),
                         .size_m = {half_length_m + 2.0, half_width_m + 2.0, 0.0},
                         .material = "floor"});
  for (const double side : {-1.0, 1.0}) {
    site.shapes.push_back(
        {.name = side < 0.0 ? "wall_right" : "wall_left",
         .T_site_shape = to_pose3(Pose2{middle_m, side * (half_width_m + kWallHalf_m), 0.0}, half_height_m),
         .size_m = {half_length_m, kWallHalf_m, half_height_m},
         .material = "wall"});
  }
  site.shapes.push_back({.name = "wall_back",
                         .T_site_shape = to_pose3(Pose2{-behind_m - kWallHalf_m, 0.0, 0.0}, half_height_m),
                         .size_m = {kWallHalf_m, half_width_m, half_height_m},
                         .material = "wall"});
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      if (course.field.at({col, row}) == 0) continue;
      const Eigen::Vector2d p = grid.center_of({col, row});
      site.shapes.push_back({.name = fmt::format("cylinder_{}_{}", col, row),
                             .type = SiteShapeType::kCylinder,
                             .T_site_shape = to_pose3(Pose2{p.x(), p.y(), 0.0}, half_height_m),
                             .size_m = {settings.scale * settings.radius_m, half_height_m, 0.0},
                             .material = "cylinder"});
    }
  }
  site.route = Route{.stations = {{.number = 1,
                                   .name = "goal",
                                   .type = StationType::kHome,
                                   .T_route_body = {course.goal_m.x(), course.goal_m.y(), 0.0},
                                   .accuracy_m = kArrival_m}}};
  site.robot = robot;
  site.scenario_keys = fmt::format("time_limit_s: {:.1f}\ncourse: {{optimal_time_s: {:.3f}, arrival_m: {:g}}}\n",
                                   100.0 * settings.scale, course.optimal_time_s, kArrival_m);
  site.stack_keys =
      "  # The passages are little wider than the robot.\n"
      "  navigation: {costmap: {resolution_m: 0.05, route_margin_m: 0.02}}\n";
  site.assumptions = {
      {"field",
       fmt::format("fill {:g}, {} smoothing steps, shortest path {:.2f} m, optimal time {:.2f} s at {:g} "
                   "m/s",
                   course.fill, course.smoothing_steps, course.path_length_m, course.optimal_time_s,
                   settings.max_speed_mps),
       "--number"}};
  return site;
}

}  // namespace patrol::importer
