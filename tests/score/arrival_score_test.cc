#include "score/arrival_score.h"

#include <gtest/gtest.h>

namespace patrol::score::arrival_score_test {
namespace {

using namespace std::chrono_literals;

/// Truth of a robot that drives from (0, 0) to (10, 0) in 10 s.
Trajectory straight_drive() { return {{Time(0s), to_pose3({0.0, 0.0, 0.0})}, {Time(10s), to_pose3({10.0, 0.0, 0.0})}}; }

Event event_at(Time stamp, EventKind kind, const std::string& subject) {
  return {.stamp = stamp, .kind = kind, .subject = subject};
}

TEST(IsArrival, HasATolerancePlusTheAccuracyOfTheGoal) {
  EXPECT_TRUE(is_arrival({1.19, 0.0}, {0.0, 0.0}, 0.2));
  EXPECT_FALSE(is_arrival({1.21, 0.0}, {0.0, 0.0}, 0.2));
  EXPECT_TRUE(is_arrival({0.0, 1.9}, {0.0, 0.0}, 1.0));
}

TEST(TruePose, OutsideOfTheGroundTruthIsItsFirstOrLastPose) {
  EXPECT_NEAR(true_pose_of(event_at(-1s, EventKind::kDocked, ""), straight_drive()).x, 0.0, 1e-12);
  EXPECT_NEAR(true_pose_of(event_at(4s, EventKind::kDocked, ""), straight_drive()).x, 4.0, 1e-12);
  EXPECT_NEAR(true_pose_of(event_at(11s, EventKind::kDocked, ""), straight_drive()).x, 10.0, 1e-12);
}

TEST(ArrivalScore, AGoalThatIsNotRequiredIsContradictedOnlyByAReport) {
  const std::vector<MissionGoal> goals = {{.name = "goal_1", .arrival = EventKind::kGoalReached, .p_world_m = {8, 0}}};
  EXPECT_FALSE(arrival_score({}, goals, straight_drive()).is_contradicted);
  const std::vector<Event> early = {event_at(1s, EventKind::kGoalReached, "goal_1")};
  EXPECT_TRUE(arrival_score(early, goals, straight_drive()).is_contradicted);
  EXPECT_EQ(arrival_score(early, goals, straight_drive()).num_false, 1U);
  const std::vector<Event> other = {event_at(1s, EventKind::kStationReached, "goal_1")};
  EXPECT_EQ(arrival_score(other, goals, straight_drive()).num_false, 0U) << "another kind of event";
}

TEST(ArrivalScore, AGoalThatTheRobotSavedIsWhereItTrulyWas) {
  const std::vector<MissionGoal> given = {{.name = "goal_1", .arrival = EventKind::kGoalReached, .p_world_m = {50, 0}}};
  std::vector<Event> events = {event_at(3s, EventKind::kGoalSaved, "goal_1"),
                               event_at(3s + 900ms, EventKind::kGoalReached, "goal_1")};
  EXPECT_EQ(arrival_score(events, given, straight_drive()).num_false, 0U);
  events.push_back(event_at(9s, EventKind::kGoalReached, "goal_1"));
  EXPECT_EQ(arrival_score(events, given, straight_drive()).num_false, 1U);
  EXPECT_FALSE(arrival_score(events, given, straight_drive()).is_contradicted) << "one arrival is true";
}

TEST(ArrivalScore, TheDockHasReportsOfAnySubject) {
  const std::vector<MissionGoal> dock = {{.name = "", .arrival = EventKind::kDocked, .p_world_m = {0.0, 0.0}}};
  EXPECT_EQ(arrival_score({event_at(9s, EventKind::kDocked, "post")}, dock, straight_drive()).num_false, 1U);
  EXPECT_EQ(arrival_score({event_at(1s, EventKind::kDocked, "")}, dock, straight_drive()).num_false, 0U);
}

}  // namespace
}  // namespace patrol::score::arrival_score_test
