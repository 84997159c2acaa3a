#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "plan/control/rollouts/rollout.h"
#include "plan/navigation/navigator.h"
#include "tests/support/room_world.h"

namespace patrol::plan {

/// 0.7 by 0.36 m.
inline RobotDescription make_robot() {
  RobotDescription robot;
  robot.name = "box";
  robot.footprint_m = {{-0.35, -0.18}, {0.35, -0.18}, {0.35, 0.18}, {-0.35, 0.18}};
  return robot;
}

/// 1.0 by 0.7 m, on tracks.
inline RobotDescription make_tracked_robot() {
  RobotDescription robot;
  robot.name = "tracked box";
  robot.footprint_m = {{-0.5, -0.35}, {0.5, -0.35}, {0.5, 0.35}, {-0.5, 0.35}};
  return robot;
}

/// 1.0 by 0.7 m with steered wheels 0.65 m ahead of the driven axle, which is at the origin, 0.2 m before the middle.
/// The minimum turning radius is 1.3 m.
inline RobotDescription make_cart() {
  RobotDescription robot;
  robot.name = "cart";
  robot.footprint_m = {{-0.2, -0.35}, {0.8, -0.35}, {0.8, 0.35}, {-0.2, 0.35}};
  robot.joint_names = {"rear_left", "rear_right", "steer_left", "steer_right"};
  const double limit_rad = std::atan(0.65 / (1.3 - 0.3));
  robot.joint_limits.assign(
      4, {.lower_rad = -limit_rad, .upper_rad = limit_rad, .velocity_radps = 10.0, .effort_nm = 10.0});
  for (const std::size_t side : {0, 1}) {
    const double y_m = side == 0 ? 0.3 : -0.3;
    robot.wheels.push_back({.link = "rear", .center_in_body = {0.0, y_m, 0.0}, .radius_m = 0.15, .drive_joint = side});
    WheelGeometry front{.link = "front", .center_in_body = {0.65, y_m, 0.0}, .radius_m = 0.15};
    front.steering_joint = 2 + side;
    robot.wheels.push_back(front);
  }
  return robot;
}

/// Distance between the robot's outline and the nearest wall; 0 if they cross.
inline double gap_m(const test::RoomWorld& world, const RobotDescription& robot, const Pose2& T_map_body) {
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); };
  const auto to_segment = [](const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - along * (b - a)).norm();
  };
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < robot.footprint_m.size(); ++i) {
    const Eigen::Vector2d p = T_map_body * robot.footprint_m[i];
    const Eigen::Vector2d q = T_map_body * robot.footprint_m[(i + 1) % robot.footprint_m.size()];
    for (const test::Segment& wall : world.walls()) {
      const bool is_apart_of_wall = cross(wall.b - wall.a, p - wall.a) * cross(wall.b - wall.a, q - wall.a) > 0.0;
      const bool is_apart_of_edge = cross(q - p, wall.a - p) * cross(q - p, wall.b - p) > 0.0;
      if (!is_apart_of_wall && !is_apart_of_edge) return 0.0;
      gap = std::min({gap, to_segment(p, wall.a, wall.b), to_segment(q, wall.a, wall.b), to_segment(wall.a, p, q),
                      to_segment(wall.b, p, q)});
    }
  }
  return gap;
}

/// The occupancy grid of an empty rectangle with walls: known free inside, occupied where a wall passes
/// through a cell.
inline OccupancyGrid draw_map(const test::RoomWorld& world, double x_min, double y_min, double x_max, double y_max) {
  constexpr double kResolution_m = 0.05;
  OccupancyGrid map({.resolution_m = kResolution_m,
                     .width = static_cast<int>(std::lround((x_max - x_min) / kResolution_m)),
                     .height = static_cast<int>(std::lround((y_max - y_min) / kResolution_m)),
                     .origin_m = {x_min, y_min}},
                    kFree);
  for (const test::Segment& wall : world.walls()) {
    const int steps = static_cast<int>(std::ceil((wall.b - wall.a).norm() / (kResolution_m / 4.0)));
    for (int i = 0; i <= steps; ++i) {
      const Cell cell = map.geometry().cell_at(wall.a + static_cast<double>(i) / steps * (wall.b - wall.a));
      if (map.contains(cell)) map.at(cell) = kOccupied;
    }
  }
  return map;
}

/// Result of a drive.
struct DriveRecord {
  NavigationStatus end = NavigationStatus::kIdle;
  double time_s = 0.0;
  double way_m = 0.0;
  double min_gap_m = std::numeric_limits<double>::infinity();
  double max_lateral_speed_mps = 0.0;  ///< asked for
  double max_curvature_per_m = 0.0;    ///< asked for: yaw rate over speed
  int num_plans = 0;
  int num_detours = 0;
  double turned_rad = 0.0;                               ///< to both sides
  NavigationFailure failure = NavigationFailure::kNone;  ///< at the end
  std::vector<std::string> texts, recoveries;
  Pose2 T_map_body;                  ///< at the end
  std::vector<Eigen::Vector2d> way;  ///< [tick], in map
};

/// World at a time.
using WorldAt = std::function<test::RoomWorld(double time_s)>;

/// Closed loop: the navigator steps at 20 Hz and sees an ideal scan at 10 Hz, until it arrives, gives up or
/// the time is over. The world is map's frame. The robot's velocity follows its command with a lag of the
/// first order; without one, at once. Tracks lose a share of the yaw rate.
inline DriveRecord drive(Navigator& navigator, const WorldAt& world_at, Pose2 T_map_body, const NavigationGoal& goal,
                         double time_limit_s, double lag_s = 0.0, const RobotDescription& robot = make_robot(),
                         double turn_slip = 0.0) {
  constexpr double kPeriod_s = 0.05;
  DriveRecord record;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // ahead, left, yaw
  navigator.set_goal(goal);
  const int ticks = static_cast<int>(std::lround(time_limit_s / kPeriod_s));
  for (int tick = 0; tick < ticks; ++tick) {
    const double time_s = kPeriod_s * tick;
    const Time now = from_seconds(time_s);
    const test::RoomWorld world = world_at(time_s);
    if (tick % 2 == 0) {
      LevelScan scan = world.scan(T_map_body, {.beams = 720});
      scan.stamp = now;
      navigator.add_scan(scan, T_map_body);
    }
    const NavigationStep step = navigator.step(now, T_map_body);
    record.num_plans += step.replanned;
    record.num_detours += step.is_detour;
    if (!step.recovery.empty()) record.recoveries.push_back(step.recovery);
    record.end = step.status;
    record.failure = step.failure;
    if (!step.text.empty()) record.texts.push_back(step.text);
    record.time_s = time_s;
    record.min_gap_m = std::min(record.min_gap_m, gap_m(world, robot, T_map_body));
    record.T_map_body = T_map_body;
    record.way.push_back(T_map_body.position());
    if (step.status == NavigationStatus::kArrived || step.status == NavigationStatus::kFailed) break;
    record.max_lateral_speed_mps = std::max(record.max_lateral_speed_mps, std::abs(step.command.vy_mps));
    if (step.command.yaw_rate_radps != 0.0) {
      record.max_curvature_per_m =
          std::max(record.max_curvature_per_m, std::abs(step.command.yaw_rate_radps / step.command.vx_mps));
    }
    const Eigen::Vector3d asked(step.command.vx_mps, step.command.vy_mps,
                                (1.0 - turn_slip) * step.command.yaw_rate_radps);
    velocity += (asked - velocity) * (lag_s > 0.0 ? 1.0 - std::exp(-kPeriod_s / lag_s) : 1.0);
    const Pose2 next =
        follow_arc(T_map_body, velocity[0], velocity[2], kPeriod_s) * Pose2{0.0, kPeriod_s * velocity[1], 0.0};
    record.turned_rad += std::abs(wrap_angle(next.yaw - T_map_body.yaw));
    record.way_m += (next.position() - T_map_body.position()).norm();
    T_map_body = next;
  }
  return record;
}

inline DriveRecord drive(Navigator& navigator, const test::RoomWorld& world, const Pose2& T_map_body,
                         const NavigationGoal& goal, double time_limit_s, double lag_s = 0.0,
                         const RobotDescription& robot = make_robot(), double turn_slip = 0.0) {
  return drive(
      navigator, [&](double) { return world; }, T_map_body, goal, time_limit_s, lag_s, robot, turn_slip);
}

}  // namespace patrol::plan
