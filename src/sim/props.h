#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/settings.h"
#include "sim/actors.h"

namespace patrol::sim {

/// Something that lies about on a building site and that a 2D lidar looks over; or a truck that is parked there.
struct PropSettings {
  std::string kind = "rebar";
  double x_m = 0.0;  ///< of its middle, in world
  double y_m = 0.0;
  double turn_deg = 0.0;  ///< of its long side from x, anticlockwise

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kind", self.kind, one_of({"rebar", "kerb", "hose", "brick", "truck"}));
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("turn_deg", self.turn_deg, between(-360.0, 360.0));
  }
};

/// How long, wide and high a kind of prop is.
struct PropSize {
  double length_m;
  double width_m;
  double height_m;  ///< above z = 0; it also goes 0.1 m into uneven ground
};

/// rebar: a bundle of 2 m; kerb: a kerbstone on its side; hose: 1.6 m of a 10 cm hose; brick: two on one
/// another; truck: a dump truck, its nose along x (sim/truck_prop.h).
PropSize prop_size(const std::string& kind);

/// Adds the props to a world: each is one touchable geom `prop_<number>`, from 1, in group 0 (a bundle of
/// rebar and a truck: a hull in group 3, and their parts to be seen). They lie at z = 0, where tunnel and street have their
/// ground to within centimetres. Throws InputError naming `props.<index>.<field>` when a setting breaks its
/// rule.
void add_props(mjSpec& world, const std::vector<PropSettings>& props);

/// Low obstacles in a robot's way: the route is cut into `count` equal parts, and one lies somewhere in each.
struct LowObstacleSettings {
  int count = 0;
  std::vector<WaypointSettings> route;
  double clear_ends_m = 4.0;  ///< of the route at both its ends nothing is put on
  double beside_m = 0.5;      ///< the middles lie this far from the route at most
  double apart_m = 2.0;       ///< the middles of neighbours are at least this way apart along the route

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("count", self.count, between(0.0, 1000.0));
    visit("route", self.route);
    visit("clear_ends_m", self.clear_ends_m, at_least(0.0));
    visit("beside_m", self.beside_m, between(0.0, 20.0));
    visit("apart_m", self.apart_m, at_least(0.0));
  }
};

/// Kinds, places and turns by seed; obstacle i is the same whatever the others are. Throws InputError when
/// the route is too short for so many.
std::vector<PropSettings> scatter_low_obstacles(const LowObstacleSettings& settings, std::uint64_t seed);

}  // namespace patrol::sim
