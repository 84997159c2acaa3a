#include "score/goal_error.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"

namespace patrol::score::goal_error_test {
namespace {

using namespace std::chrono_literals;

Event event(EventKind kind, const char* subject, Time stamp, double value = 0.0) {
  Event event;
  event.kind = kind;
  event.subject = subject;
  event.stamp = stamp;
  event.value = value;
  return event;
}

/// At 1 s at (10, 0), at 2 s 3 cm ahead and 4 cm beside of it and turned by 2 degrees, at 3 s exactly there.
Trajectory truth() {
  return {
      {1s, to_pose3({10.0, 0.0, 0.0})}, {2s, to_pose3({10.03, 0.04, 2.0 * kDegree})}, {3s, to_pose3({10.0, 0.0, 0.0})}};
}

TEST(GoalErrors, AMarkedGoalIsMetWhereTheRobotTrulyStoodAtTheMark) {
  const std::vector<Event> events = {
      event(EventKind::kGoalSaved, "goal_1", 1s), event(EventKind::kGoalReached, "goal_1", 2s, 1),
      event(EventKind::kGoalReached, "goal_1", 3s, 2), event(EventKind::kGoalFailed, "goal_1", 3s, 3)};
  const std::vector<GoalError> errors = goal_errors(events, {}, {}, truth());
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].name, "goal_1");
  EXPECT_EQ(errors[0].num_failed, 1);
  ASSERT_EQ(errors[0].arrivals.size(), 2u);
  EXPECT_NEAR(errors[0].arrivals[0].position_error_m, 0.05, 1e-12);
  EXPECT_NEAR(errors[0].arrivals[0].heading_error_deg, 2.0, 1e-9);
  EXPECT_EQ(errors[0].arrivals[1].navigation, 2);
  EXPECT_NEAR(errors[0].position_errors_m()[1], 0.0, 1e-12);
}

TEST(GoalErrors, AGivenGoalIsMetWhereTheMapLiesInTheWorld) {
  const SavedGoal goal{.number = 4, .T_map_body = {8.0, 0.0, 0.0}};
  const std::vector<GoalError> errors =
      goal_errors({event(EventKind::kGoalReached, "goal_4", 1s, 1)}, {goal}, {1.0, 0.0, 0.0}, truth());
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NEAR(errors[0].arrivals[0].position_error_m, 1.0, 1e-12);
}

TEST(GoalErrors, AReportFarFromTheGoalIsNoArrival) {
  const SavedGoal goal{.number = 1, .T_map_body = {0.0, 0.0, 0.0}, .accuracy_m = 0.2};
  const auto num_arrivals = [&](double x_m) {
    const Trajectory truth = {{1s, to_pose3({x_m, 0.0, 0.0})}, {2s, to_pose3({x_m, 0.0, 0.0})}};
    const std::vector<Event> events = {event(EventKind::kGoalReached, "goal_1", 2s, 1)};
    return goal_errors(events, {goal}, {}, truth).at(0).arrivals.size();
  };
  EXPECT_EQ(num_arrivals(1.19), 1U);
  EXPECT_EQ(num_arrivals(1.21), 0U);
  EXPECT_EQ(num_arrivals(32.0), 0U);
}

TEST(GoalErrors, AReportAfterTheLastTruePoseIsComparedWithIt) {
  const SavedGoal goal{.number = 1, .T_map_body = {10.0, 0.0, 0.0}};
  EXPECT_EQ(goal_errors({event(EventKind::kGoalReached, "goal_1", 4s, 1)}, {goal}, {}, truth()).at(0).arrivals.size(),
            1U);
}

TEST(DockingError, AReportFarFromTheDockIsNoDocking) {
  EXPECT_TRUE(docking_error({event(EventKind::kDocked, "", 2s, 1)}, {8.9, 0.0, 0.0}, truth()).arrivals.empty());
}

TEST(DockingError, CountsDockingsAndFailures) {
  const GoalError error = docking_error({event(EventKind::kDocked, "", 2s, 1), event(EventKind::kDockFailed, "", 3s)},
                                        {10.03, 0.0, 0.0}, truth());
  EXPECT_EQ(error.num_failed, 1);
  ASSERT_EQ(error.arrivals.size(), 1u);
  EXPECT_NEAR(error.arrivals[0].position_error_m, 0.04, 1e-12);
}

}  // namespace
}  // namespace patrol::score::goal_error_test
