#include "stack/motion_executor.h"

#include <gtest/gtest.h>

#include "tests/stack/standing_quadruped.h"
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

}  // namespace
}  // namespace patrol::stack::motion_executor_test
