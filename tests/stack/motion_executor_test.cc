#include "stack/motion_executor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/stack/standing_quadruped.h"
#include "tests/support/depth_scene.h"
#include "tests/support/dock_world.h"
#include "tests/support/pose_near.h"

namespace patrol::stack::motion_executor_test {
namespace {

const Pose2 kMapDocked{5.0, 1.0, 0.0};

MotionExecutor executor_beside_dock() {
  Route site;
  site.dock = Dock{.T_route_docked = kMapDocked, .profile_m = test::make_notched_dock_profile()};
  return MotionExecutor(StackSettings{}, quadruped_with_outline(), site, 1);
}

std::optional<DockDetection> detection_at(MotionExecutor& executor, const Pose2& T_map_body, double time_s) {
  const test::RoomWorld world = test::make_dock_world(kMapDocked, test::make_notched_dock_profile());
  const LevelScan scan =
      test::scan_from_mast(world, T_map_body, from_seconds(time_s), 0.01, RandomStream(1, "test/lidar"), 0);
  return executor.add(scan, {.T_odom_body = T_map_body, .T_map_body = T_map_body});
}

TEST(MotionExecutor, DetectsTheChargingPostOnceASecondWhereItIsNear) {
  MotionExecutor executor = executor_beside_dock();
  const Pose2 T_map_body{3.8, 1.1, 0.05};
  const std::optional<DockDetection> first = detection_at(executor, T_map_body, 1.0);
  ASSERT_TRUE(first);
  EXPECT_THAT(T_map_body * first->T_level_docked, test::Pose2Near(kMapDocked, 0.02, 0.02));
  EXPECT_FALSE(detection_at(executor, T_map_body, 1.5));
  EXPECT_TRUE(detection_at(executor, T_map_body, 2.1));
}

TEST(MotionExecutor, DoesNotSearchTheChargingPostFarAway) {
  MotionExecutor executor = executor_beside_dock();
  EXPECT_FALSE(detection_at(executor, {0.0, 1.0, 0.0}, 1.0));
}

constexpr double kTransducerHeight_m = 0.2;  // above the ground
constexpr double kFov_rad = 0.6;

/// The quadruped with a transducer and a depth camera that look forward.
RobotDescription quadruped_with_near_sensors() {
  RobotDescription robot = quadruped_with_outline();
  robot.T_body_sensor["ultrasonic_0"] = {{0.3, 0.0, kTransducerHeight_m - robot.body_height_m()},
                                         Eigen::Quaterniond::Identity()};
  robot.T_body_sensor["depth_camera"] = {{0.3, 0.0, 0.3}, Eigen::Quaterniond::Identity()};
  return robot;
}

/// Pose of the standing robot at the map's origin.
StationPose standing(const RobotDescription& robot, double pitch_rad = 0.0) {
  return {.T_level_body = {{0.0, 0.0, robot.body_height_m()}, quaternion_from_rpy(0.0, pitch_rad, 0.0)},
          .T_map_body = {}};
}

/// Whether a goal ahead of the robot is blocked in the costmap.
bool is_goal_blocked(MotionExecutor& executor, double x_m) {
  const Task task{.motion = Motion::kNavigate, .goal = NavigationGoal{.T_map_body = {x_m, 0.0, 0.0}}, .inspection = {}};
  StackOutput output;
  executor.step(from_seconds(2.0), task, {}, {}, output);
  for (const Event& event : all_of<Event>(output.take_messages())) {
    if (event.text == "Goal pose is blocked: obstacle, keep-out line or unknown space.") return true;
  }
  return false;
}

/// Whether two pings at a range leave an arc in the costmap.
bool leaves_arc(double range_m, double pitch_rad = 0.0) {
  const RobotDescription robot = quadruped_with_near_sensors();
  MotionExecutor executor(StackSettings{}, robot, Route{}, 1);
  for (const double time_s : {1.0, 1.1})
    executor.add(UltrasonicRange{.stamp = from_seconds(time_s),
                                 .transducer = 0,
                                 .field_of_view_rad = kFov_rad,
                                 .range_min_m = 0.1,
                                 .range_max_m = 4.0,
                                 .range_m = static_cast<float>(range_m)},
                 standing(robot, pitch_rad));
  return is_goal_blocked(executor, 0.3 + range_m);
}

// The range to level ground is that of the lower edge of the cone; from 0.85 of it on, an echo may be the ground. With
// the nose 0.2 rad down, the range is shorter.
TEST(MotionExecutor, APingOfTheRangeToLevelGroundLeavesNoArc) {
  const double ground_range_m = kTransducerHeight_m / std::sin(kFov_rad / 2.0);
  EXPECT_FALSE(leaves_arc(ground_range_m));
  EXPECT_FALSE(leaves_arc(0.87 * ground_range_m));
  EXPECT_TRUE(leaves_arc(0.83 * ground_range_m));
  EXPECT_FALSE(leaves_arc(0.83 * ground_range_m, 0.2));
}

// A beam from 0.68 to 0.78 m above the ground, half a meter before the camera.
TEST(MotionExecutor, ABeamSeventyFiveCentimetersAboveTheGroundIsAnObstacle) {
  const RobotDescription robot = quadruped_with_near_sensors();
  const StationPose pose = standing(robot);
  test::DepthScene scene;
  scene.add_box({0.8, -0.5, 0.68}, {0.9, 0.5, 0.78});
  MotionExecutor executor(StackSettings{}, robot, Route{}, 1);
  for (const double time_s : {1.0, 1.2})
    executor.add(scene.look(pose.T_level_body * robot.T_body("depth_camera"), from_seconds(time_s)), pose);
  EXPECT_TRUE(is_goal_blocked(executor, 0.85));
}

}  // namespace
}  // namespace patrol::stack::motion_executor_test
