#include "sim/teleop_operator.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"

namespace patrol::sim::teleop_operator_test {
namespace {

constexpr double kTick_s = 0.02;

/// Result of a drive of a robot that executes commands at once.
struct Driven {
  std::vector<Pose2> marks;
  std::optional<Time> handed_over;
  Pose2 T_world_body;
  double nearest_m = 1e9;   ///< minimum distance from `p_watched`
  double way_back_m = 0.0;  ///< driven in reverse
};

Driven drive(const TeleopRoute& way, const Pose2& start, const TeleopOperatorSettings& settings = {},
             double seconds = 120.0, const std::vector<Eigen::Vector2d>& people = {},
             const Eigen::Vector2d& p_watched = {0.0, 0.0}) {
  TeleopOperator person(settings, way, 7);
  Driven driven{.marks = {}, .handed_over = {}, .T_world_body = start};
  TeleopCommand command;
  for (double t = 0.0; t < seconds && !driven.handed_over; t += kTick_s) {
    if (const auto next = person.step(from_seconds(t), driven.T_world_body, people)) command = *next;
    if (command.save_goal) driven.marks.push_back(driven.T_world_body);
    if (command.hand_over) driven.handed_over = from_seconds(t);
    driven.T_world_body = driven.T_world_body * Pose2{command.vx_mps * kTick_s, 0.0, command.yaw_rate_radps * kTick_s};
    driven.nearest_m = std::min(driven.nearest_m, (driven.T_world_body.position() - p_watched).norm());
    driven.way_back_m += std::max(0.0, -command.vx_mps * kTick_s);
    command.save_goal = false;
  }
  return driven;
}

TEST(TeleopOperator, MarksWithinTenCentimetresAndThreeDegreesAndHandsOverAtTheEnd) {
  const Driven driven =
      drive({{.p_m = {6.0, 0.0}}, {.p_m = {12.0, 2.0}, .is_goal = true, .heading_rad = 1.0}, {.p_m = {4.0, 3.0}}}, {});
  ASSERT_EQ(driven.marks.size(), 1u);
  EXPECT_LT((driven.marks[0].position() - Eigen::Vector2d(12.0, 2.0)).norm(), 0.10);
  EXPECT_LT(std::abs(wrap_angle(driven.marks[0].yaw - 1.0)), to_rad(3.0));
  ASSERT_TRUE(driven.handed_over.has_value());
  EXPECT_LT((driven.T_world_body.position() - Eigen::Vector2d(4.0, 3.0)).norm(), 0.10);
}

TEST(TeleopOperator, WaitsFourSecondsForTheRobotToStandWhereTheyMeet) {
  TeleopOperator person({.wait_for_robot = true}, {{.p_m = {10.0, 0.0}}, {.p_m = {20.0, 0.0}}}, 7);
  double first_s = 0.0;
  for (double t = 0.0; t < 60.0 && first_s == 0.0; t += kTick_s) {
    const Pose2 passing_then_standing{std::min(0.5 * t, 9.5), 0.0, 0.0};  // there at 19 s
    if (person.step(from_seconds(t), passing_then_standing, {})) first_s = t;
  }
  EXPECT_NEAR(first_s, 19.0 + 4.0, 0.3);
}

TEST(TeleopOperator, WaitsAtAMarkWhileTheRobotIsBusy) {
  TeleopOperator person({}, {{.p_m = {1.0, 0.0}, .is_goal = true}, {.p_m = {5.0, 0.0}}}, 7);
  Pose2 T_world_body;
  double marked_s = 0.0, moved_on_s = 0.0;
  for (double t = 0.0; t < 60.0 && moved_on_s == 0.0; t += kTick_s) {
    const bool is_busy = marked_s > 0.0 && t > marked_s && t < marked_s + 20.0;
    const auto command = person.step(from_seconds(t), T_world_body, {}, is_busy);
    if (!command) continue;
    if (command->save_goal) marked_s = t;
    if (marked_s > 0.0 && t > marked_s && command->vx_mps > 0.0) moved_on_s = t;
    T_world_body = T_world_body * Pose2{command->vx_mps * 0.1, 0.0, command->yaw_rate_radps * 0.1};
  }
  EXPECT_NEAR(moved_on_s - marked_s, 20.0 + 1.5, 0.4);
}

TEST(TeleopOperator, BacksOutOfTheDock) {
  const Driven driven =
      drive({{.p_m = {2.0, 0.0}, .is_reverse = true}, {.p_m = {8.0, 0.0}}}, {0.0, 0.0, std::numbers::pi});
  EXPECT_GT(driven.way_back_m, 1.2);
  EXPECT_TRUE(driven.handed_over.has_value());
}

TEST(TeleopOperator, WaitsForSomebodyInTheWay) {
  const Eigen::Vector2d person(5.0, 0.2);
  const Driven driven = drive({{.p_m = {10.0, 0.0}}, {.p_m = {12.0, 0.0}}}, {}, {}, 60.0, {person}, person);
  EXPECT_FALSE(driven.handed_over.has_value());
  EXPECT_GT(driven.nearest_m, 1.5);
}

TEST(TeleopOperator, KeepsWithinTwentyCentimetresOfAStraightLegWithAReactionTimeOfAQuarterSecond) {
  TeleopOperator person({}, {{.p_m = {30.0, 0.0}}, {.p_m = {31.0, 0.0}}}, 3);
  Pose2 T;
  TeleopCommand command;
  double farthest = 0.0;
  for (double t = 0.0; t < 30.0; t += kTick_s) {
    if (const auto next = person.step(from_seconds(t), T, {})) command = *next;
    T = T * Pose2{command.vx_mps * kTick_s, 0.0, command.yaw_rate_radps * kTick_s};
    farthest = std::max(farthest, std::abs(T.y));
  }
  EXPECT_GT(T.x, 20.0);
  EXPECT_LT(farthest, 0.2);
}

}  // namespace
}  // namespace patrol::sim::teleop_operator_test
