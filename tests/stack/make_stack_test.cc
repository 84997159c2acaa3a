#include "stack/make_stack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/stack/standing_quadruped.h"
#include "tests/support/tracked_drive.h"

namespace patrol::stack::make_stack_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Route route_with_a_station() {
  Route route;
  route.stations = {{.number = 1,
                     .name = "here",
                     .type = StationType::kInspect,
                     .T_route_body = {},
                     .p_route_target = {2.0, 0.0, 0.3}}};
  return route;
}

StackSettings quick_gas_settings() {
  StackSettings settings;
  settings.gas_mission.init_wait_s = 2.0;
  settings.gas_mission.measurement_duration_s = 1.0;
  return settings;
}

StackSettings goal_settings() {
  StackSettings settings;
  settings.mission_type = "tunnel";
  settings.tunnel_mission.num_runs = 1;
  settings.tunnel_mission.start_docked = settings.tunnel_mission.dock_after_run = false;
  settings.tunnel_mission.start_at_survey = true;
  settings.tunnel_mission.init_wait_s = 3.0;
  return settings;
}

std::vector<EventKind> kinds_of(const std::vector<StackMessage>& messages) {
  std::vector<EventKind> kinds;
  for (const Event& event : all_of<Event>(messages)) kinds.push_back(event.kind);
  return kinds;
}

TEST(MakeStack, AQuadrupedMeasuresGasWhileItMaps) {
  const RobotDescription robot = quadruped_with_outline();
  Stack stack = make_stack(quick_gas_settings(), robot, route_with_a_station(), {.seed = 1});
  const std::vector<StackMessage> messages = stand(stack, robot, 8.0, 900.0);
  EXPECT_THAT(kinds_of(messages),
              ::testing::ElementsAre(EventKind::kMissionStarted, EventKind::kStationReached, EventKind::kGasMeasured,
                                     EventKind::kGasAlarm, EventKind::kMissionCompleted));
  EXPECT_TRUE(stack.mission_is_over());
  EXPECT_GE(all_of<MapUpdate>(messages).size(), 1U);
  EXPECT_TRUE(all_of<LocalizationConfidence>(messages).empty());
  for (const PoseEstimate& pose : all_of<PoseEstimate>(messages)) EXPECT_LT(pose.T_map_body.position().norm(), 0.05);
}

TEST(MakeStack, AQuadrupedDrivesToMarkedGoalsOnAKnownMap) {
  const RobotDescription robot = quadruped_with_outline();
  Stack stack = make_stack(goal_settings(), robot, {},
                           {.map = map_of_small_room(), .goals = {{.number = 1, .T_map_body = {}}}, .seed = 1});
  const std::vector<StackMessage> messages = stand(stack, robot, 8.0);
  EXPECT_THAT(kinds_of(messages), ::testing::ElementsAre(EventKind::kNavigationStarted, EventKind::kGoalReached,
                                                         EventKind::kMissionCompleted));
  EXPECT_TRUE(all_of<MapUpdate>(messages).empty());  // the map is known
  ASSERT_FALSE(all_of<LocalizationConfidence>(messages).empty());
  EXPECT_FALSE(all_of<LocalizationConfidence>(messages).back().is_lost);
  EXPECT_LT(all_of<PoseEstimate>(messages).back().T_map_body.position().norm(), 0.05);
}

TEST(MakeStack, AGasPatrolOnAKnownMapUsesThatMap) {
  const RobotDescription robot = quadruped_with_outline();
  Stack stack =
      make_stack(quick_gas_settings(), robot, route_with_a_station(), {.map = map_of_small_room(), .seed = 1});
  const std::vector<StackMessage> messages = stand(stack, robot, 8.0);
  EXPECT_TRUE(stack.mission_is_over());
  EXPECT_FALSE(all_of<LocalizationConfidence>(messages).empty());
  stack.finish({});
  EXPECT_EQ(all_of<MapUpdate>(stack.take_messages()).back().map.values(), map_of_small_room().values());
}

TEST(MakeStack, ATrackedRobotMayPatrolForGas) {
  RobotDescription robot = test::make_tracked_robot();
  robot.footprint_m = quadruped_with_outline().footprint_m;
  robot.T_body_sensor["lidar"] = robot.T_body_sensor["tdlas"] = Pose3{{0.1, 0.0, 0.4}, Eigen::Quaterniond::Identity()};
  StackSettings settings;
  settings.odometry_source = "tracked";
  EXPECT_FALSE(make_stack(settings, robot, route_with_a_station(), {}).mission_is_over());
}

TEST(MakeStack, RefusesPartsThatDoNotGoTogether) {
  const RobotDescription quadruped = quadruped_with_outline();
  StackSettings settings;
  settings.odometry_source = "tracked";
  EXPECT_THAT([&] { make_stack(settings, quadruped, route_with_a_station(), {}); },
              ThrowsMessage<InputError>(HasSubstr("has no tracks")));
  settings.odometry_source = "wheeled";
  EXPECT_THAT([&] { make_stack(settings, quadruped, route_with_a_station(), {}); },
              ThrowsMessage<InputError>(HasSubstr("neither tracks nor wheels")));
  settings = {};
  settings.localizer = "monte_carlo";
  EXPECT_THAT([&] { make_stack(settings, quadruped, route_with_a_station(), {}); },
              ThrowsMessage<InputError>(HasSubstr("stack.localizer = monte_carlo: requires a map")));
  settings.localizer = "slam";
  EXPECT_THAT([&] { make_stack(settings, quadruped, route_with_a_station(), {.map = map_of_small_room()}); },
              ThrowsMessage<InputError>(HasSubstr("stack.localizer = slam: would replace the given map")));
  settings.localizer = "slam_then_monte_carlo";
  EXPECT_THAT([&] { make_stack(settings, quadruped, route_with_a_station(), {}); },
              ThrowsMessage<InputError>(HasSubstr("requires a teleoperated mapping drive")));
}

TEST(MakeStack, RefusesAGasStationWithoutAMethaneMeter) {
  RobotDescription robot = quadruped_with_outline();
  robot.T_body_sensor.erase("tdlas");
  EXPECT_THAT([&] { make_stack({}, robot, route_with_a_station(), {}); },
              ThrowsMessage<InputError>(HasSubstr("tdlas")));
}

TEST(MakeStack, ADockingWithoutADockNamesTheKeysThatNeedIt) {
  const auto complaint = [](bool starts_docked, bool docks_after_run) -> std::string {
    StackSettings settings = goal_settings();
    settings.tunnel_mission.start_docked = starts_docked;
    settings.tunnel_mission.start_at_survey = !starts_docked;
    settings.tunnel_mission.dock_after_run = docks_after_run;
    try {
      make_stack(settings, quadruped_with_outline(), {},
                 {.map = map_of_small_room(), .goals = {{.number = 1, .T_map_body = {}}}});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(false, true), "stack.tunnel_mission.dock_after_run = true: requires a dock in the site survey");
  EXPECT_EQ(complaint(true, false), "stack.tunnel_mission.start_docked = true: requires a dock in the site survey");
  EXPECT_EQ(
      complaint(true, true),
      "stack.tunnel_mission.dock_after_run = true: requires a dock in the site survey, and start_docked = true too");
  EXPECT_EQ(complaint(false, false), "");
}

}  // namespace
}  // namespace patrol::stack::make_stack_test
