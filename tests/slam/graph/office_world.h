#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "core/random.h"
#include "core/time.h"
#include "tests/support/room_world.h"

namespace patrol::test {

/// A building of 44 m x 30 m: a corridor 2.4 m wide runs round between offices outside and inside, each with a door of
/// its own place and width and furniture of its own. The corridor's middle is the rectangle from (4.2, 4.2) to
/// (39.8, 25.8).
inline RoomWorld make_office() {
  RoomWorld office;
  office.add_box(0.0, 0.0, 44.0, 30.0);
  const RandomStream layout(7, "test/office");
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) { return low + (high - low) * layout.uniform(draw++); };
  // A wall from `from` along `along`, with an office behind it (on the side of `out`) every four meters or so.
  const auto add_offices = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& along, const Eigen::Vector2d& out,
                               double length, double depth) {
    const auto at = [&](double a, double o) -> Eigen::Vector2d { return from + a * along + o * out; };
    for (double s = 0.0; s < length - 2.5;) {
      const double width = std::min(uniform(3.2, 5.5), length - s), door = s + uniform(0.3, 0.8),
                   opening = uniform(0.8, 1.1);
      office.add_polyline({at(s, depth), at(s, 0.0), at(door, 0.0), at(door, 0.15)});
      office.add_polyline({at(door + opening, 0.15), at(door + opening, 0.0), at(std::min(s + width, length), 0.0)});
      const double desk = s + uniform(1.2, 2.0), back = uniform(0.5, 0.7) * depth;
      office.add_polyline({at(desk, depth), at(desk, back), at(desk + 0.8, back), at(desk + 0.8, depth)});
      s += width;
    }
  };
  add_offices({3.0, 3.0}, {1, 0}, {0, -1}, 38.0, 3.0);
  add_offices({41.0, 3.0}, {0, 1}, {1, 0}, 24.0, 3.0);
  add_offices({3.0, 27.0}, {1, 0}, {0, 1}, 38.0, 3.0);
  add_offices({3.0, 3.0}, {0, 1}, {-1, 0}, 24.0, 3.0);
  add_offices({5.4, 5.4}, {1, 0}, {0, 1}, 33.2, 5.0);
  add_offices({38.6, 5.4}, {0, 1}, {-1, 0}, 19.2, 5.0);
  add_offices({5.4, 24.6}, {1, 0}, {0, -1}, 33.2, 5.0);
  add_offices({5.4, 5.4}, {0, 1}, {1, 0}, 19.2, 5.0);
  return office;
}

/// Points along a wall at y = `y` from x = `begin` to `end`, with a door niche 1 m wide every `spacing` from `first`
/// on, m.
inline std::vector<Eigen::Vector2d> wall_with_doors(double y, double begin, double end, double first, double spacing,
                                                    double niche_depth = 0.3) {
  std::vector<Eigen::Vector2d> wall = {{begin, y}};
  const double out = y < 0.0 ? -niche_depth : niche_depth;
  for (double x = first; x < end - 1.0; x += spacing) {
    for (const auto& [dx, depth] : {std::pair{0.0, 0.0}, {0.0, out}, {1.0, out}, {1.0, 0.0}})
      wall.emplace_back(x + dx, y + depth);
  }
  wall.emplace_back(end, y);
  return wall;
}

/// A corridor of 60 m with a door niche every three meters on both sides, all alike, closed at both ends.
inline RoomWorld make_corridor_of_doors() {
  RoomWorld corridor;
  for (const double side : {-1.0, 1.0}) corridor.add_polyline(wall_with_doors(side, 0.0, 60.0, 1.0, 3.0));
  corridor.add_wall(0.0, -1.0, 0.0, 1.0).add_wall(60.0, -1.0, 60.0, 1.0);
  return corridor;
}

/// A corridor along x, 2.4 m wide and open at both ends, 100 m and more from the origin, with a door niche every
/// `spacing_m` on both sides.
inline RoomWorld make_endless_corridor_of_doors(double spacing_m, double phase_m, double niche_depth_m = 0.3) {
  RoomWorld corridor;
  for (const double side : {-1.2, 1.2})
    corridor.add_polyline(wall_with_doors(side, -110.0, 150.0, -100.0 + phase_m, spacing_m, niche_depth_m));
  return corridor;
}

struct DriveStep {
  Time stamp{};
  Pose2 T_world_body;
  Pose2 T_odom_body;
};

struct DriveOptions {
  double speed_mps = 0.6;
  double turn_radps = 0.6;
  double period_s = 0.2;
  double odometry_scale = 0.03;  ///< relative error of the distance by odometry; positive: too long
  double odometry_drift_rad_per_m = 0.01;
};

/// Drive from corner to corner with a turn in place at each. Odometry begins at zero.
inline std::vector<DriveStep> drive_along(const std::vector<Eigen::Vector2d>& corners, const DriveOptions& options) {
  std::vector<Pose2> poses;
  Pose2 pose{corners[0].x(), corners[0].y(),
             std::atan2(corners[1].y() - corners[0].y(), corners[1].x() - corners[0].x())};
  poses.push_back(pose);
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d way = corners[i + 1] - corners[i];
    const double heading = std::atan2(way.y(), way.x()), turn = wrap_angle(heading - pose.yaw);
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / (options.turn_radps * options.period_s)));
    for (int k = 1; k <= turns; ++k) poses.push_back({pose.x, pose.y, wrap_angle(pose.yaw + turn * k / turns)});
    const int steps = static_cast<int>(std::ceil(way.norm() / (options.speed_mps * options.period_s)));
    for (int k = 1; k <= steps; ++k) {
      const Eigen::Vector2d p = corners[i] + way * k / steps;
      poses.push_back({p.x(), p.y(), heading});
    }
    pose = poses.back();
  }
  std::vector<DriveStep> drive;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    DriveStep step{
        .stamp = from_seconds(options.period_s * static_cast<double>(k)), .T_world_body = poses[k], .T_odom_body = {}};
    if (k > 0) {
      Pose2 motion = poses[k - 1].inverse() * poses[k];
      const double way = motion.position().norm();
      motion.x *= 1.0 + options.odometry_scale;
      motion.yaw += options.odometry_drift_rad_per_m * way;
      step.T_odom_body = drive.back().T_odom_body * motion;
    }
    drive.push_back(step);
  }
  return drive;
}

/// Rounds of the office's corridor.
inline std::vector<Eigen::Vector2d> office_rounds(int rounds) {
  std::vector<Eigen::Vector2d> corners = {{8.0, 4.2}};
  for (int round = 0; round < rounds; ++round) {
    for (const auto& corner : {Eigen::Vector2d(39.8, 4.2), Eigen::Vector2d(39.8, 25.8), Eigen::Vector2d(4.2, 25.8),
                               Eigen::Vector2d(4.2, 4.2)})
      corners.push_back(corner);
  }
  corners.emplace_back(14.0, 4.2);
  return corners;
}

/// Options of an old laser scanner: one beam per degree, noise of 1 cm.
inline constexpr RoomWorld::ScanOptions kOldLidar{
    .beams = 360, .range_max_m = 30.0, .no_return_clearing_range_m = 6.0, .range_std_m = 0.01};

}  // namespace patrol::test
