#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/frames.h"
#include "core/geometry/angles.h"
#include "core/messages.h"
#include "core/random.h"
#include "core/time.h"
#include "tests/support/room_world.h"

namespace patrol::test {

/// A right-angle street of 60 m x 100 m: along x = 10 from y = 0, then along y = 77 to x = 60, both 14 m between the
/// house fronts, with recessed doors, alleys, a ragged hedge, lamp posts, trees, parked cars and bins.
inline RoomWorld make_street() {
  RoomWorld street;
  const RandomStream layout(1, "test/street");
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) { return low + (high - low) * layout.uniform(draw++); };

  // A row of houses from `from` along `along`, fronts facing `out`; a door recess in each and an alley between them.
  const auto add_row = [&](Eigen::Vector2d from, Eigen::Vector2d along, Eigen::Vector2d out, double length) {
    const double depth = 8.0;
    for (double s = 0.0; s < length - 5.0;) {
      const double width = std::min(uniform(7.0, 11.0), length - s), set_back = uniform(-0.4, 0.4);
      const double door = uniform(1.5, width - 3.0), recess = uniform(0.15, 0.4), window = uniform(0.05, 0.1);
      const auto at = [&](double a, double o) -> Eigen::Vector2d {
        return from + (s + a) * along + (o + set_back) * out;
      };
      street.add_polyline({at(0, -depth), at(0, 0), at(door, 0), at(door, -recess), at(door + 1.0, -recess),
                           at(door + 1.0, 0), at(width - 1.2, 0), at(width - 1.2, -window), at(width - 0.3, -window),
                           at(width - 0.3, 0), at(width, 0), at(width, -depth)});
      s += width + uniform(0.8, 2.0);
    }
  };
  add_row({3, 0}, {0, 1}, {1, 0}, 84);    // west side
  add_row({17, 0}, {0, 1}, {-1, 0}, 70);  // east side
  add_row({3, 84}, {1, 0}, {0, -1}, 57);  // north side
  add_row({17, 70}, {1, 0}, {0, 1}, 43);  // south side
  street.add_wall(3, -2, 17, -2).add_wall(61, 70, 61, 84);

  for (double s = 6.0; s < 70.0; s += 14.0) street.add_post(13.6, s, 0.08).add_post(6.3, s + 7.0, 0.15);
  for (double s = 24.0; s < 58.0; s += 12.0) street.add_post(s, 73.6, 0.08).add_post(s + 5.0, 80.7, 0.18);
  for (double y : {9.0, 21.0, 27.0, 40.0, 53.0}) street.add_box(11.4, y, 13.2, y + 4.3);
  for (double x : {26.0, 38.0}) street.add_box(x, 79.0, x + 4.4, 80.8);
  for (double y : {15.0, 33.0, 47.0}) street.add_box(3.6, y, 4.2, y + 0.7);
  std::vector<Eigen::Vector2d> hedge;
  for (double y = 56.0; y < 66.0; y += 0.12) hedge.emplace_back(4.6 + uniform(-0.12, 0.12), y);
  street.add_polyline(hedge);
  return street;
}

/// Two walkers and a car, where they are at time t.
inline RoomWorld make_traffic(double t_s) {
  RoomWorld traffic;
  const auto back_and_forth = [](double way, double length) {
    const double phase = std::fmod(way, 2.0 * length);
    return phase < length ? phase : 2.0 * length - phase;
  };
  const auto add_walker = [&](double x, double y, double along_x, double along_y) {
    const double stride = 0.25 * std::sin(2.0 * std::numbers::pi * t_s);
    traffic.add_post(x + 0.1 * along_y + stride * along_x, y - 0.1 * along_x + stride * along_y, 0.07);
    traffic.add_post(x - 0.1 * along_y - stride * along_x, y + 0.1 * along_x - stride * along_y, 0.07);
  };
  add_walker(5.5, 5.0 + back_and_forth(1.2 * t_s, 60.0), 0, 1);
  add_walker(18.0 + back_and_forth(1.0 * t_s, 35.0), 82.0, 1, 0);
  const double car = 2.0 + back_and_forth(3.0 * t_s, 62.0);
  traffic.add_box(10.2, car, 11.1, car + 4.2);
  return traffic;
}

/// Input of the filter from a walk, and the ground truth; all of them aligned at the start.
struct WalkStep {
  Time stamp{};
  Pose2 T_world_body;
  Pose2 T_start_body = {};  ///< truth, in map
  Pose2 T_odom_body = {};
};

struct WalkOptions {
  double period_s = 0.1;
  double speed_mps = 0.8;
  double north_m = 65.0;  ///< out and back
  double east_m = 30.0;
  double odometry_scale = 0.02;  ///< legs overrate the way
  double odometry_drift_degpmin = 1.5;
};

/// North, a bend, east, a stop of five seconds, a turn in place, and the same way back. The trunk sways with the gait.
/// Odometry has a scale error, a constant yaw drift, sideways slip and white noise.
inline std::vector<WalkStep> make_walk(const WalkOptions& options, std::uint64_t seed) {
  const RandomStream noise(seed, "test/odometry");
  const double pi = std::numbers::pi, radius = 4.0, turn_rate = 0.8;
  const double straight_1 = options.north_m - radius, bend = 0.5 * pi * radius, straight_2 = options.east_m - radius;
  const double length = straight_1 + bend + straight_2;
  const double walk_s = length / options.speed_mps, stop_s = 5.0, turn_s = pi / turn_rate;
  // The center line out, by way.
  const auto on_line = [&](double way) -> Pose2 {
    if (way < straight_1) return {8.6, 8.0 + way, pi / 2};
    const double angle = std::min((way - straight_1) / radius, pi / 2);
    const double rest = std::max(0.0, way - straight_1 - bend);
    return {8.6 + radius * (1 - std::cos(angle)) + rest, 8.0 + straight_1 + radius * std::sin(angle), pi / 2 - angle};
  };
  const auto truth_at = [&](double t) -> Pose2 {
    Pose2 pose;
    const bool walks = t < walk_s || t > walk_s + stop_s + turn_s;
    if (t < walk_s) {
      pose = on_line(options.speed_mps * t);
    } else {
      const double turned = turn_rate * std::clamp(t - walk_s - stop_s, 0.0, turn_s);
      pose = on_line(std::max(0.0, length - options.speed_mps * std::max(0.0, t - walk_s - stop_s - turn_s)));
      pose.yaw = wrap_angle(pose.yaw + turned);
    }
    if (walks && t > 1.0)
      pose = pose * Pose2{0.0, 0.01 * std::sin(2 * pi * 1.7 * t), 0.02 * std::sin(2 * pi * 2.5 * t)};
    return pose;
  };

  std::vector<WalkStep> steps;
  const auto num_steps = static_cast<std::uint64_t>((2 * walk_s + stop_s + turn_s) / options.period_s);
  for (std::uint64_t i = 0; i <= num_steps; ++i) {
    const double t = options.period_s * static_cast<double>(i);
    WalkStep step{.stamp = from_seconds(t), .T_world_body = truth_at(t)};
    if (i > 0) {
      const WalkStep& last = steps.back();
      Pose2 move = last.T_world_body.inverse() * step.T_world_body;
      const double way = move.position().norm();
      move.x = move.x * (1.0 + options.odometry_scale) + 0.001 * noise.normal(i, 0);
      move.y = move.y + 0.01 * way + 0.001 * noise.normal(i, 1);
      move.yaw += to_rad(options.odometry_drift_degpmin) / 60.0 * options.period_s + 0.0005 * noise.normal(i, 2);
      step.T_odom_body = last.T_odom_body * move;
    }
    step.T_start_body = truth_at(0.0).inverse() * step.T_world_body;
    steps.push_back(step);
  }
  return steps;
}

}  // namespace patrol::test
