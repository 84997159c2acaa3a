#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/random.h"
#include "tests/support/room_world.h"

namespace patrol::test {

/// Selects the part of a world that a submap contains.
using Keep = std::function<bool(const Eigen::Vector2d& p_world)>;

struct WallSampling {
  double spacing_m = 0.1;
  double phase = 0.0;  ///< phase of the first point on a wall, in spacings, so that two submaps have different points
  double std_m = 0.0;
  std::uint64_t seed = 1;
};

/// The surface points of a submap whose frame lies at `T_world_submap`: points along the walls that are kept, in
/// submap.
inline std::vector<Eigen::Vector2d> sample_walls(
    const RoomWorld& world, const Pose2& T_world_submap, const WallSampling& sampling = {},
    const Keep& keep = [](const Eigen::Vector2d&) { return true; }) {
  const RandomStream noise(sampling.seed, "test/sample_walls");
  const Pose2 T_submap_world = T_world_submap.inverse();
  std::vector<Eigen::Vector2d> points;
  std::uint64_t tick = 0;
  for (const Segment& wall : world.walls()) {
    const double length = (wall.b - wall.a).norm();
    const Eigen::Vector2d along = (wall.b - wall.a) / length;
    for (double s = sampling.phase * sampling.spacing_m; s < length; s += sampling.spacing_m) {
      const Eigen::Vector2d p = wall.a + s * along;
      if (!keep(p)) continue;
      const auto jitter = noise.normals(tick++);
      points.push_back(T_submap_world * (p + sampling.std_m * Eigen::Vector2d(jitter[0], jitter[1])));
    }
  }
  return points;
}

/// A yard of 20 m by 16 m: two walls of a building, a hut, a transformer on its base, a fence with a gate, six posts.
inline RoomWorld make_yard() {
  RoomWorld yard;
  yard.add_polyline({{-10.0, -8.0}, {-10.0, 6.5}, {-6.0, 6.5}, {-6.0, 8.0}, {4.0, 8.0}});
  yard.add_box(4.0, -7.0, 8.0, -4.5).add_box(-5.0, -2.0, -1.5, 0.5);
  yard.add_polyline({{10.0, -6.0}, {10.0, 1.0}}).add_polyline({{10.0, 4.0}, {10.0, 8.0}, {7.0, 8.0}});
  for (const auto& [x, y] : {std::pair{1.0, 2.0}, {3.5, 2.2}, {6.0, 2.0}, {1.2, 5.0}, {3.5, 5.0}, {6.1, 5.2}})
    yard.add_post(x, y, 0.15, 6);
  return yard;
}

/// Two submaps of the yard that overlap in a strip: where their frames lie, and what lies on one side of a line of
/// each.
inline const Pose2 kYardTarget{-2.0, 0.0, 0.2}, kYardSource{1.0, 1.0, -0.4};
inline std::vector<Eigen::Vector2d> yard_target_left_of(double x) {
  return sample_walls(make_yard(), kYardTarget, {.phase = 0.2, .std_m = 0.01, .seed = 1},
                      [x](const auto& p) { return p.x() < x; });
}
inline std::vector<Eigen::Vector2d> yard_source_right_of(double x) {
  return sample_walls(make_yard(), kYardSource, {.phase = 0.7, .std_m = 0.01, .seed = 2},
                      [x](const auto& p) { return p.x() > x; });
}

}  // namespace patrol::test
