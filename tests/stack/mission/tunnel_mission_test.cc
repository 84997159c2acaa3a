#include "stack/mission/tunnel_mission.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::stack::tunnel_mission_test {
namespace {

using ::testing::ElementsAre;

constexpr Time kStep = std::chrono::milliseconds(50);

std::vector<SavedGoal> two_goals() {
  return {{.number = 1, .T_map_body = {10.0, 0.0, 0.0}}, {.number = 2, .T_map_body = {20.0, 1.0, 1.0}}};
}

/// A robot that does at once whatever the tour wants, unless told otherwise.
class Robot {
 public:
  explicit Robot(TunnelMission tour) : tour_(std::move(tour)) {}

  bool is_lost = false;
  NavigationFeedback navigation = NavigationFeedback::kArrived;
  DockingFeedback docking = DockingFeedback::kDone;
  InspectionFeedback inspection = InspectionFeedback::kDone;

  void run(double seconds, std::optional<TeleopCommand> teleop = std::nullopt) {
    for (const Time end = now_ + from_seconds(seconds); now_ < end && !tour_.is_over(); now_ += kStep) {
      if (output.task.goal) pose_ = output.task.goal->T_map_body;
      output = tour_.step(now_, {.pose = {.stamp = now_, .T_map_body = pose_},
                                 .is_lost = is_lost,
                                 .navigation = navigation,
                                 .docking = docking,
                                 .inspection = {.feedback = inspection},
                                 .teleop = teleop});
      if (teleop) teleop->save_goal = teleop->hand_over = false;
      for (const Event& event : output.events) events.push_back(event);
      if (const int run = count(EventKind::kNavigationStarted); run > static_cast<int>(relocalizations.size()))
        relocalizations.push_back(output.relocalization);
      restarts += output.relocalization != Relocalization::kNone ? 1 : 0;
      maps += output.is_map_complete ? 1 : 0;
    }
  }
  int count(EventKind kind) const {
    return static_cast<int>(
        std::count_if(events.begin(), events.end(), [&](const Event& e) { return e.kind == kind; }));
  }
  const TunnelMission& tour() const { return tour_; }

  MissionOutput output;
  std::vector<Event> events;
  std::vector<Relocalization> relocalizations;  ///< [run] relocalization at its start
  int restarts = 0;
  int maps = 0;

 private:
  TunnelMission tour_;
  Time now_{};
  Pose2 pose_;
};

TEST(TunnelMission, TenNavigationsOfTwoGoalsReachTwentyAndDockTenTimes) {
  Robot robot(TunnelMission({}, two_goals(), false));
  robot.run(1000.0);
  EXPECT_TRUE(robot.tour().is_over());
  EXPECT_EQ(robot.count(EventKind::kNavigationStarted), 10);
  EXPECT_EQ(robot.count(EventKind::kGoalReached), 20);
  EXPECT_EQ(robot.count(EventKind::kDocked), 10);
  EXPECT_EQ(robot.count(EventKind::kMissionCompleted), 1);
  EXPECT_EQ(robot.events.back().text, "Every goal was reached.");
  EXPECT_EQ(robot.restarts, 10);
}

TEST(TunnelMission, MarksGoalsByRemoteControlThenDrivesToThemByItself) {
  Robot robot(TunnelMission({.num_runs = 1}, {}, true));
  robot.run(5.0);
  EXPECT_EQ(robot.output.task.motion, Motion::kTeleop);
  robot.run(1.0, TeleopCommand{.vx_mps = 0.5});
  robot.run(1.0, TeleopCommand{.save_goal = true});
  robot.run(1.0, TeleopCommand{.save_goal = true});
  EXPECT_EQ(robot.maps, 0);
  robot.run(1.0, TeleopCommand{.hand_over = true});
  EXPECT_EQ(robot.maps, 1);
  robot.run(100.0);
  EXPECT_EQ(robot.count(EventKind::kGoalSaved), 2);
  EXPECT_EQ(robot.count(EventKind::kGoalReached), 2);
  EXPECT_EQ(robot.count(EventKind::kDocked), 2);
  EXPECT_EQ(robot.count(EventKind::kMissionCompleted), 1);
}

// The final optimization moves the place of the first goal by 0.2 m and that of the second by 0.5 m.
TEST(TunnelMission, SavedGoalsFollowTheFinalOptimizationOfTheMap) {
  TunnelMission mission({.num_runs = 1}, {}, true);
  const auto save_goal_at = [&](double time_s, double x_m) {
    mission.step(from_seconds(time_s), {.pose = {.T_map_body = {x_m, 0.0, 0.0}}});
    mission.step(from_seconds(time_s + 1.0),
                 {.pose = {.T_map_body = {x_m, 0.0, 0.0}}, .teleop = TeleopCommand{.save_goal = true}});
  };
  for (int i = 0; i <= 48; ++i) mission.step(from_seconds(0.1 * i), {});
  save_goal_at(5.0, 10.0);
  save_goal_at(6.5, 20.0);
  ASSERT_EQ(mission.goals().size(), 2U);
  const std::vector<Event> events =
      mission.correct_map(from_seconds(9.0), {.stamps = {from_seconds(5.9), from_seconds(7.4)},
                                              .T_map_old = {{0.2, 0.0, 0.0}, {0.5, 0.0, 0.0}}});
  EXPECT_NEAR(mission.goals()[0].T_map_body.x, 10.2, 1e-12);
  EXPECT_NEAR(mission.goals()[1].T_map_body.x, 20.5, 1e-12);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1].kind, EventKind::kGoalMoved);
  EXPECT_EQ(events[1].subject, "goal_2");
  EXPECT_NEAR(events[1].T_map_body.x, 20.5, 1e-12);
}

TEST(TunnelMission, ARemoteControlThatFallsSilentForTwoSecondsIsOff) {
  Robot robot(TunnelMission({.num_runs = 0, .dock_after_run = false}, {}, true));
  robot.run(4.1);
  robot.run(1.0, TeleopCommand{.vx_mps = 0.5});
  robot.run(1.9);
  EXPECT_EQ(robot.output.task.motion, Motion::kTeleop);
  robot.run(0.3);
  EXPECT_EQ(robot.count(EventKind::kMappingCompleted), 1);
  EXPECT_TRUE(robot.tour().is_over());
  EXPECT_EQ(robot.events.back().text, "No goals were saved.");
}

TEST(TunnelMission, AGoalWithoutAWayIsReportedAndLeftOut) {
  Robot robot(TunnelMission({.num_runs = 1}, two_goals(), false));
  robot.navigation = NavigationFeedback::kFailed;
  robot.run(100.0);
  EXPECT_EQ(robot.count(EventKind::kGoalFailed), 2);
  EXPECT_EQ(robot.events.back().text, "Tasks failed: 2.");
  EXPECT_EQ(robot.count(EventKind::kMissionFailed), 1);
  EXPECT_EQ(robot.count(EventKind::kMissionCompleted), 0);
}

TEST(TunnelMission, ADockingThatFailsFailsTheMission) {
  Robot robot(TunnelMission({.num_runs = 1, .start_docked = false}, two_goals(), false));
  robot.docking = DockingFeedback::kFailed;
  robot.run(100.0);
  EXPECT_EQ(robot.count(EventKind::kDockFailed), 1);
  EXPECT_EQ(robot.count(EventKind::kMissionFailed), 1);
}

// The dock's pose would be wrong by the distance to it, at 3 cm of standard deviation.
TEST(TunnelMission, ARunAfterAFailedDockingKeepsThePose) {
  Robot robot(TunnelMission({.num_runs = 2}, two_goals(), false));
  robot.navigation = NavigationFeedback::kDriving;
  robot.run(6.0);
  EXPECT_EQ(robot.output.task.motion, Motion::kNavigate);  // it has left the post
  robot.navigation = NavigationFeedback::kArrived;
  robot.docking = DockingFeedback::kFailed;
  robot.run(100.0);
  EXPECT_EQ(robot.count(EventKind::kDockFailed), 2);
  EXPECT_THAT(robot.relocalizations, ElementsAre(Relocalization::kAtDock, Relocalization::kNone));
}

TEST(TunnelMission, ARunWithoutDockingBeforeItKeepsThePose) {
  Robot robot(TunnelMission({.num_runs = 2, .dock_after_run = false}, two_goals(), false));
  robot.run(100.0);
  EXPECT_THAT(robot.relocalizations, ElementsAre(Relocalization::kAtDock, Relocalization::kNone));
  Robot with_operator(TunnelMission({.num_runs = 1, .dock_after_run = false}, {}, true));
  with_operator.run(5.0);
  with_operator.run(1.0, TeleopCommand{.save_goal = true});
  with_operator.run(100.0);
  EXPECT_THAT(with_operator.relocalizations, ElementsAre(Relocalization::kNone));
}

TEST(TunnelMission, AFailedUndockingEndsTheMission) {
  Robot robot(TunnelMission({.num_runs = 2}, two_goals(), false));
  robot.docking = DockingFeedback::kInProgress;
  robot.run(10.0);
  EXPECT_EQ(robot.output.task.motion, Motion::kUndock);
  robot.docking = DockingFeedback::kFailed;
  robot.run(1.0);
  EXPECT_TRUE(robot.tour().is_over());
  EXPECT_EQ(robot.output.task.motion, Motion::kStand);
  ASSERT_EQ(robot.count(EventKind::kDockFailed), 1);
  EXPECT_EQ(robot.events[robot.events.size() - 2].text, "Undocking failed.");
  EXPECT_EQ(robot.events.back().kind, EventKind::kMissionFailed);
}

TEST(TunnelMission, LostItStandsAndGoesOnOnceItKnows) {
  Robot robot(TunnelMission({.num_runs = 1, .start_docked = false, .dock_after_run = false}, two_goals(), false));
  robot.navigation = NavigationFeedback::kDriving;
  robot.run(6.0);
  EXPECT_EQ(robot.output.task.motion, Motion::kNavigate);
  robot.is_lost = true;
  robot.run(10.0);
  EXPECT_EQ(robot.output.task.motion, Motion::kStand);
  EXPECT_EQ(robot.count(EventKind::kLocalizationLost), 1);
  robot.is_lost = false;
  robot.navigation = NavigationFeedback::kArrived;
  robot.run(10.0);
  EXPECT_EQ(robot.count(EventKind::kRelocalized), 1);
  EXPECT_EQ(robot.count(EventKind::kMissionCompleted), 1);
}

TEST(TunnelMission, LostForThirtySecondsItSaysThatItCannotTell) {
  Robot robot(TunnelMission({.num_runs = 1, .start_docked = false}, two_goals(), false));
  robot.is_lost = true;
  robot.run(4.0 + 29.0);
  EXPECT_EQ(robot.count(EventKind::kLocalizationFailed), 0);
  robot.run(2.0);
  EXPECT_EQ(robot.count(EventKind::kLocalizationFailed), 1);
  EXPECT_TRUE(robot.tour().is_over());
}

/// A goal at which the lining is scanned, and one from which a person drives on.
std::vector<SavedGoal> inspection_goals() {
  std::vector<SavedGoal> goals = two_goals();
  goals[0].type = GoalType::kScan;
  goals[1].type = GoalType::kOperator;
  return goals;
}

TEST(TunnelMission, StandsAtAGoalOfTypeDUntilTheLiningIsScanned) {
  Robot robot(TunnelMission({.num_runs = 1}, inspection_goals(), false));
  robot.inspection = InspectionFeedback::kInProgress;
  robot.run(60.0);
  EXPECT_EQ(robot.output.task.inspection.value().instrument, InstrumentKind::kLining);
  EXPECT_EQ(robot.output.task.inspection.value().station, "goal_1");
  robot.inspection = InspectionFeedback::kDone;
  robot.run(60.0);
  EXPECT_EQ(robot.count(EventKind::kMissionCompleted), 1);
}

TEST(TunnelMission, ARobotThatIsLateToKnowHowItMovesStandsForOneAndAHalfSecondsFromThenOn) {
  TunnelMission tour({.num_runs = 1, .start_docked = false}, two_goals(), false);
  Time started{};
  for (Time now = std::chrono::seconds(7); started == Time{}; now += kStep) {
    if (tour.step(now, {}).task.motion == Motion::kNavigate) started = now;
  }
  EXPECT_NEAR(to_seconds(started), 8.5, 0.06);
}

TEST(TunnelMission, AScanThatFailsIsReportedAndTheRoundGoesOn) {
  Robot robot(TunnelMission({.num_runs = 1}, inspection_goals(), false));
  robot.inspection = InspectionFeedback::kFailed;
  robot.run(60.0);
  EXPECT_EQ(robot.count(EventKind::kInspectionFailed), 1);
  EXPECT_EQ(robot.count(EventKind::kGoalReached), 2);
  EXPECT_EQ(robot.count(EventKind::kDocked), 1);
  EXPECT_EQ(robot.count(EventKind::kMissionFailed), 1);
}

TEST(TunnelMission, AtAGoalOfTypeRAPersonDrivesMarksAndHandsOverAgain) {
  Robot robot(TunnelMission({.num_runs = 1}, inspection_goals(), true, true));
  robot.run(30.0);
  EXPECT_EQ(robot.count(EventKind::kTeleopRequested), 1);
  EXPECT_EQ(robot.output.task.motion, Motion::kTeleop);
  robot.run(10.0, TeleopCommand{.vx_mps = 0.5});
  robot.inspection = InspectionFeedback::kInProgress;
  robot.run(10.0, TeleopCommand{.save_goal = true});
  EXPECT_EQ(robot.output.task.inspection.value().instrument, InstrumentKind::kWater);
  EXPECT_EQ(robot.output.task.inspection.value().station, "sounding_1");
  robot.inspection = InspectionFeedback::kDone;
  robot.run(10.0, TeleopCommand{.vx_mps = 0.5});
  EXPECT_EQ(robot.output.task.motion, Motion::kTeleop);
  robot.run(60.0, TeleopCommand{.hand_over = true});
  EXPECT_EQ(robot.count(EventKind::kGoalSaved), 0);
  EXPECT_EQ(robot.count(EventKind::kDocked), 1);
  EXPECT_EQ(robot.count(EventKind::kMissionCompleted), 1);
}

TEST(TunnelMission, NobodyComesFor120SecondsAndItGoesHomeByItselfWithoutCallingItDone) {
  Robot robot(TunnelMission({.num_runs = 1}, inspection_goals(), true, true));
  robot.run(5.0 + 119.0);
  EXPECT_EQ(robot.output.task.motion, Motion::kTeleop);
  robot.run(30.0);
  EXPECT_EQ(robot.count(EventKind::kDocked), 1);
  EXPECT_EQ(robot.count(EventKind::kMissionFailed), 1);
}

TEST(TunnelMission, MarksTakeTheTypesThatTheSettingsName) {
  Robot robot(TunnelMission({.num_runs = 0, .dock_after_run = false, .goal_types = "DR"}, {}, true));
  robot.run(5.0);
  for (int i = 0; i < 3; ++i) robot.run(0.5, TeleopCommand{.save_goal = true});
  ASSERT_EQ(robot.tour().goals().size(), 3u);
  EXPECT_EQ(robot.tour().goals()[0].type, GoalType::kScan);
  EXPECT_EQ(robot.tour().goals()[1].type, GoalType::kOperator);
  EXPECT_EQ(robot.tour().goals()[2].type, GoalType::kStop);
  EXPECT_THROW(TunnelMission({.goal_types = "DX"}, {}, true), InputError);
}

TEST(TunnelMission, NeitherGoalsNorRemoteControlIsRefused) { EXPECT_THROW(TunnelMission({}, {}, false), InputError); }

}  // namespace
}  // namespace patrol::stack::tunnel_mission_test
