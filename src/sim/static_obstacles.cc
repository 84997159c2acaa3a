#include "sim/static_obstacles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "core/text.h"
#include "sim/robot_model.h"
#include "sim/truck_obstacle.h"

namespace patrol::sim {
namespace {

constexpr std::array kLowKinds = {"rebar", "kerb", "hose", "brick"};
constexpr double kFoot_m = 0.1;  // depth below the ground surface

using Color = std::array<float, 4>;
constexpr Color kRust = {0.42f, 0.24f, 0.14f, 1.0f}, kStone = {0.56f, 0.55f, 0.52f, 1.0f},
                kBlue = {0.10f, 0.26f, 0.52f, 1.0f}, kBrick = {0.55f, 0.25f, 0.18f, 1.0f};

mjsGeom* add_geom(mjsBody& body, mjtGeom type, const StaticObstacleSettings& obstacle, const Color& color) {
  mjsGeom* geom = mjs_addGeom(&body, nullptr);
  geom->type = type;
  geom->pos[0] = obstacle.x_m;
  geom->pos[1] = obstacle.y_m;
  const double half_turn = obstacle.yaw_deg * std::numbers::pi / 360.0;
  geom->quat[0] = std::cos(half_turn);
  geom->quat[3] = std::sin(half_turn);
  geom->group = kGroupSolid;
  geom->contype = geom->conaffinity = 0;
  std::copy(color.begin(), color.end(), geom->rgba);
  return geom;
}

/// Makes a geom collidable and names it.
void make_solid(mjsGeom& geom, int number) {
  mjs_setName(geom.element, fmt::format("{}{}", kStaticObstacle, number).c_str());
  geom.contype = 1;
  geom.conaffinity = 2;
}

void add_block(mjsBody& body, const StaticObstacleSettings& obstacle, int number, int group, const Color& color) {
  const StaticObstacleSize size = static_obstacle_size(obstacle.kind);
  mjsGeom* block = add_geom(body, mjGEOM_BOX, obstacle, color);
  block->group = group;
  block->pos[2] = (size.height_m - kFoot_m) / 2.0;
  block->size[0] = size.length_m / 2.0;
  block->size[1] = size.width_m / 2.0;
  block->size[2] = (size.height_m + kFoot_m) / 2.0;
  make_solid(*block, number);
}

/// Adds a rod along the object's long side, `aside_m` to its left.
mjsGeom* add_rod(mjsBody& body, const StaticObstacleSettings& obstacle, double radius_m, double aside_m,
                 double height_m, const Color& color) {
  mjsGeom* rod = add_geom(body, mjGEOM_CAPSULE, obstacle, color);
  const double turn = to_rad(obstacle.yaw_deg);
  rod->pos[0] -= aside_m * std::sin(turn);
  rod->pos[1] += aside_m * std::cos(turn);
  rod->pos[2] = height_m;
  // The axis of a capsule is z: rotate it to x, then by the object's angle.
  const double s = std::sqrt(0.5), w = std::cos(turn / 2.0), z = std::sin(turn / 2.0);
  const double rotated[4] = {w * s, -z * s, w * s, z * s};
  std::copy_n(rotated, 4, rod->quat);
  rod->size[0] = radius_m;
  rod->size[1] = static_obstacle_size(obstacle.kind).length_m / 2.0 - radius_m;
  return rod;
}

void add_rebar(mjsBody& body, const StaticObstacleSettings& obstacle, int number) {
  constexpr double kRadius_m = 0.016;
  const StaticObstacleSize size = static_obstacle_size(obstacle.kind);
  for (int layer = 0; layer < 3; ++layer) {
    for (int bar = 0; bar < 5 - layer; ++bar) {
      const double aside = (bar - 0.5 * (4 - layer)) * (size.width_m - 2.0 * kRadius_m) / 4.0;
      const double height = kRadius_m + layer * (size.height_m - 2.0 * kRadius_m) / 2.0;
      add_rod(body, obstacle, kRadius_m, aside, height, kRust);
    }
  }
  add_block(body, obstacle, number, kGroupCollisionOnly, kRust);
}

void add_truck(mjsBody& body, const StaticObstacleSettings& obstacle, int number) {
  const double turn = to_rad(obstacle.yaw_deg), c = std::cos(turn), s = std::sin(turn);
  for (const TruckPart& part : truck_parts()) {
    const bool is_wheel = part.shape == TruckPart::Shape::kWheel;
    mjsGeom* geom = add_geom(body, is_wheel ? mjGEOM_CYLINDER : mjGEOM_BOX, obstacle, part.rgba);
    geom->pos[0] += c * part.center[0] - s * part.center[1];
    geom->pos[1] += s * part.center[0] + c * part.center[1];
    geom->pos[2] = part.center[2];
    std::copy(part.half.begin(), part.half.end(), geom->size);
    if (!is_wheel) continue;
    const double half = std::sqrt(0.5), w = geom->quat[0], z = geom->quat[3];  // the axis of a cylinder is z: rotate it
                                                                               // to y, then by the object's angle
    const double rotated[4] = {w * half, w * half, z * half, z * half};
    std::copy_n(rotated, 4, geom->quat);
  }
  add_block(body, obstacle, number, kGroupCollisionOnly, kStone);
}

void add_static_obstacle(mjsBody& body, const StaticObstacleSettings& obstacle, int number) {
  if (obstacle.kind == "rebar") return add_rebar(body, obstacle, number);
  if (obstacle.kind == "kerb") return add_block(body, obstacle, number, kGroupSolid, kStone);
  if (obstacle.kind == "brick") return add_block(body, obstacle, number, kGroupSolid, kBrick);
  if (obstacle.kind == "truck") return add_truck(body, obstacle, number);
  const double radius = static_obstacle_size("hose").height_m / 2.0;
  make_solid(*add_rod(body, obstacle, radius, 0.0, radius, kBlue), number);
}

struct RoutePoint {
  Eigen::Vector2d point;
  Eigen::Vector2d ahead;  ///< unit vector along the route
};

double length_m(const std::vector<WaypointSettings>& route) {
  double length = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    length += std::hypot(route[i].x_m - route[i - 1].x_m, route[i].y_m - route[i - 1].y_m);
  }
  return length;
}

RoutePoint point_at(const std::vector<WaypointSettings>& route, double along_m) {
  RoutePoint found{};
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Eigen::Vector2d from(route[i - 1].x_m, route[i - 1].y_m), to(route[i].x_m, route[i].y_m);
    const double leg = (to - from).norm();
    if (leg <= 0.0) continue;
    found = {.point = from + std::min(along_m / leg, 1.0) * (to - from), .ahead = (to - from) / leg};
    if (along_m <= leg) break;
    along_m -= leg;
  }
  return found;
}

}  // namespace

StaticObstacleSize static_obstacle_size(const std::string& kind) {
  if (kind == "rebar") return {.length_m = 2.0, .width_m = 0.16, .height_m = 0.10};
  if (kind == "kerb") return {.length_m = 1.0, .width_m = 0.15, .height_m = 0.22};
  if (kind == "hose") return {.length_m = 1.6, .width_m = 0.10, .height_m = 0.10};
  if (kind == "brick") return {.length_m = 0.25, .width_m = 0.12, .height_m = 0.14};
  if (kind == "truck") return {.length_m = 7.6, .width_m = 2.5, .height_m = 3.0};
  throw InputError(fmt::format("static_obstacles.kind = {}: must be one of {}, truck", kind, join(kLowKinds, ", ")));
}

void add_static_obstacles(mjSpec& world, const std::vector<StaticObstacleSettings>& obstacles) {
  mjsBody* body = mjs_findBody(&world, "world");
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    validate(obstacles[i], fmt::format("static_obstacles.{}", i));
    add_static_obstacle(*body, obstacles[i], static_cast<int>(i) + 1);
  }
}

std::vector<StaticObstacleSettings> scatter_low_obstacles(const LowObstacleSettings& settings, std::uint64_t seed) {
  validate(settings, "low_obstacles");
  if (settings.count == 0) return {};
  const double part = (length_m(settings.route) - 2.0 * settings.end_clearance_m) / settings.count;
  if (!(part > settings.min_spacing_m)) {
    throw InputError(
        fmt::format("low_obstacles.route: length {:.1f} m: too short for {} obstacles with min_spacing_m = {} and "
                    "end_clearance_m = {}",
                    length_m(settings.route), settings.count, settings.min_spacing_m, settings.end_clearance_m));
  }
  const RandomStream random(seed, "low_obstacles");
  std::vector<StaticObstacleSettings> obstacles;
  for (int i = 0; i < settings.count; ++i) {
    const auto obstacle = static_cast<std::uint64_t>(i);
    const double in_part = random.uniform(obstacle, 0) * (part - settings.min_spacing_m) + settings.min_spacing_m / 2.0;
    const RoutePoint point = point_at(settings.route, settings.end_clearance_m + i * part + in_part);
    const double lateral_m = settings.max_lateral_offset_m * (2.0 * random.uniform(obstacle, 1) - 1.0);
    const auto kind = static_cast<std::size_t>(random.uniform(obstacle, 2) * kLowKinds.size());
    obstacles.push_back({.kind = kLowKinds[kind],
                         .x_m = point.point.x() - lateral_m * point.ahead.y(),
                         .y_m = point.point.y() + lateral_m * point.ahead.x(),
                         .yaw_deg = 180.0 * random.uniform(obstacle, 3)});
  }
  return obstacles;
}

}  // namespace patrol::sim
