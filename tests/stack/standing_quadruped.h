#pragma once

#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "core/robot_description.h"
#include "stack/stack.h"
#include "tests/support/room_world.h"
#include "tests/support/walking_robot.h"

namespace patrol::stack {

/// Description of the kinematic quadruped, with what a stack needs: an outline, and a methane meter.
inline RobotDescription quadruped_with_outline() {
  RobotDescription robot = test::make_quadruped();
  robot.footprint_m = {{-0.3, -0.2}, {0.3, -0.2}, {0.3, 0.2}, {-0.3, 0.2}};
  robot.T_body_sensor["tdlas"] = Pose3{{0.2, 0.0, 0.1}, Eigen::Quaterniond::Identity()};
  return robot;
}

/// Room of 6 m by 4 m about the map's origin.
inline test::RoomWorld small_room() {
  test::RoomWorld room;
  return room.add_box(-2.0, -2.0, 4.0, 2.0);
}

/// The room as an occupancy grid of 5 cm.
inline OccupancyGrid map_of_small_room() {
  OccupancyGrid map({.resolution_m = 0.05, .width = 122, .height = 82, .origin_m = {-2.05, -2.05}}, kFree);
  for (int y = 0; y < 82; ++y) {
    for (int x = 0; x < 122; ++x) {
      if (x == 0 || y == 0 || x == 121 || y == 81) map.at({x, y}) = kOccupied;
    }
  }
  return map;
}

/// Scan of a room; the lidar turns in no time.
inline LaserScan scan_of(const test::RoomWorld& room, Time stamp, const Pose2& T_map_lidar) {
  constexpr int kBeams = 360;
  LaserScan scan{.stamp = stamp,
                 .angle_increment_rad = 2.0 * std::numbers::pi / kBeams,
                 .scan_time_s = 0.1,
                 .range_min_m = 0.1,
                 .range_max_m = 30.0,
                 .ranges_m = {},
                 .intensities = {}};
  for (const double range_m : room.ranges_m(T_map_lidar, kBeams, scan.range_max_m))
    scan.ranges_m.push_back(static_cast<float>(range_m));
  return scan;
}

/// Feeds a stack with the sensors of a robot that stands at the map's origin, tick by tick, for the given seconds. The
/// stack has a step after every tick, or once per `step_period`.
inline std::vector<StackMessage> stand(Stack& stack, const RobotDescription& robot, double seconds,
                                       double gas_ppm_m = 20.0, Time step_period = {}) {
  const test::RoomWorld room = small_room();
  const Pose3& T_body_lidar = robot.T_body("lidar");
  test::WalkingRobot walker(robot, test::stand_then_walk(1e9, {}), test::WalkingRobotSettings::without_noise(), 1);
  std::vector<StackMessage> messages;
  Time next_step{};
  for (int tick = 0; to_seconds(walker.now()) < seconds; ++tick) {
    walker.step();
    stack.handle(walker.imu(), walker.now());
    stack.handle(walker.joints(), walker.now());
    stack.handle(walker.contacts(), walker.now());
    if (tick % 25 == 0)
      stack.handle(scan_of(room, walker.now(), {T_body_lidar.position.x(), T_body_lidar.position.y(), 0.0}),
                   walker.now());
    if (tick % 25 == 0)
      stack.handle(GasReading{.stamp = walker.now(), .column_ppm_m = gas_ppm_m, .path_length_m = 2.0}, walker.now());
    if (walker.now() < next_step) continue;
    next_step = walker.now() + step_period;
    stack.step(walker.now());
    for (StackMessage& message : stack.take_messages()) messages.push_back(std::move(message));
  }
  return messages;
}

/// Messages of one type, in order.
template <typename Message>
std::vector<Message> all_of(const std::vector<StackMessage>& messages) {
  std::vector<Message> found;
  for (const StackMessage& message : messages) {
    if (const auto* one = std::get_if<Message>(&message)) found.push_back(*one);
  }
  return found;
}

}  // namespace patrol::stack
