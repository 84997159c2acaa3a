#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/settings.h"
#include "sim/actors.h"

namespace patrol::sim {

/// Begin of the names of the geoms of static obstacles, which are never ground.
inline constexpr const char* kStaticObstacle = "static_obstacle_";

/// Object on a building site below the plane of a 2D lidar, or a parked truck.
struct StaticObstacleSettings {
  std::string kind = "rebar";  ///< kind of the obstacle: rebar, kerb, hose, brick or truck
  double x_m = 0.0;            ///< x of the center in the world
  double y_m = 0.0;            ///< y of the center in the world
  double yaw_deg = 0.0;        ///< angle of the long side from x, counterclockwise

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kind", self.kind, one_of({"rebar", "kerb", "hose", "brick", "truck"}));
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("yaw_deg", self.yaw_deg, between(-360.0, 360.0));
  }
};

/// Dimensions of a kind of object.
struct StaticObstacleSize {
  double length_m;
  double width_m;
  double height_m;  ///< height above z = 0; the object extends another 0.1 m into uneven ground
};

/// Returns the dimensions of a kind. rebar: a bundle of 2 m; kerb: a kerbstone on its side; hose: 1.6 m of a 10 cm
/// hose; brick: two bricks, stacked; truck: a dump truck with its nose along x (sim/truck_obstacle.h).
StaticObstacleSize static_obstacle_size(const std::string& kind);

/// Adds the objects to a world. Each is one collision geom `static_obstacle_<number>`, from 1, in group 0. A rebar
/// bundle and a truck have a hull in group 3 and visual parts. Objects lie at z = 0, within centimeters of the ground
/// of tunnel and street. Throws InputError naming `static_obstacles.<index>.<field>` when a setting is out of range.
void add_static_obstacles(mjSpec& world, const std::vector<StaticObstacleSettings>& obstacles);

/// Low obstacles along a robot's route. The route is divided into `count` equal parts, each with one obstacle at a
/// random position.
struct LowObstacleSettings {
  int count = 0;  ///< number of obstacles, one in each of as many equal parts of the route
  std::vector<WaypointSettings> route;
  double end_clearance_m = 4.0;       ///< length at both ends of the route that stays free of obstacles
  double max_lateral_offset_m = 0.5;  ///< maximum lateral offset of the centers from the route
  double min_spacing_m = 2.0;         ///< minimum distance between the centers of neighbors along the route

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("count", self.count, between(0.0, 1000.0));
    visit("route", self.route);
    visit("end_clearance_m", self.end_clearance_m, at_least(0.0));
    visit("max_lateral_offset_m", self.max_lateral_offset_m, between(0.0, 20.0));
    visit("min_spacing_m", self.min_spacing_m, at_least(0.0));
  }
};

/// Returns obstacles with kinds, positions and angles determined by `seed`; obstacle i does not depend on the others.
/// Throws InputError when the route is too short for `count` obstacles.
std::vector<StaticObstacleSettings> scatter_low_obstacles(const LowObstacleSettings& settings, std::uint64_t seed);

}  // namespace patrol::sim
