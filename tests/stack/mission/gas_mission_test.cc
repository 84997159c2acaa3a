#include "stack/mission/gas_mission.h"

#include "tests/stack/mission/gas_mission_parts.h"

namespace patrol::stack::gas_mission_test {
namespace {

TEST(GasMission, WalksMeasuresAndCompletesInOrder) {
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, clean_air);
  EXPECT_THAT(record.kinds(), ElementsAre(EventKind::kMissionStarted, EventKind::kStationReached,
                                          EventKind::kGasMeasured, EventKind::kStationReached, EventKind::kGasMeasured,
                                          EventKind::kStationReached, EventKind::kMissionCompleted));
  EXPECT_EQ(record.events[1].subject, "first");
  EXPECT_EQ(record.events[3].subject, "second");
  EXPECT_EQ(record.events[5].subject, "home");  // nothing is measured there
  EXPECT_EQ(record.events[6].text, "Every station was inspected.");
  EXPECT_TRUE(mission.is_over());
}

TEST(GasMission, ThatInspectsNothingReportsThatItsStationsWereReached) {
  Route route = make_route();
  for (Station& station : route.stations) station.type = StationType::kPass;
  GasRound mission(make_settings(), route, {});
  EXPECT_EQ(run(mission, clean_air).find(EventKind::kMissionCompleted).text, "Every station was reached.");
}

TEST(GasMission, NamesItsStationsWhenItStarts) {
  GasRound mission(make_settings(), make_route(), {}, "They should take 9 s.");
  EXPECT_EQ(run(mission, clean_air).find(EventKind::kMissionStarted).text,
            "Mission started: 3 stations, first, second, home. They should take 9 s.");
}

// It arrives after three seconds and measures one and a half; the second station opens at the tenth.
TEST(GasMission, WaitsForAStationsWindowAndSaysHowLateItIs) {
  Route route = make_route();
  route.stations[0].latest_s = 2.0;
  route.stations[1].earliest_s = 10.0;
  GasRound mission(make_settings(), route, {});
  const MissionRecord record = run(mission, clean_air);
  EXPECT_NEAR(record.find(EventKind::kStationLate, "first").value,
              to_seconds(record.find(EventKind::kStationReached, "first").stamp) - 2.0, 1e-9);
  EXPECT_EQ(record.count(EventKind::kStationLate), 1);
  EXPECT_LT(to_seconds(record.find(EventKind::kStationReached, "second").stamp), 10.0);
  EXPECT_NEAR(to_seconds(record.find(EventKind::kGasMeasured, "second").stamp), 10.0 + 0.5 + 1.0, kPeriod_s + 1e-9);
}

TEST(GasMission, StandsForItsStartWait) {
  GasRound mission(make_settings(), make_route(), {});
  for (int tick = 0; tick < 10; ++tick) {
    const MissionOutput output =
        mission.step(from_seconds(kPeriod_s * tick), {}, NavigationFeedback::kDriving, std::nullopt);
    EXPECT_FALSE(output.task.goal) << tick;
    EXPECT_TRUE(output.events.empty()) << tick;
  }
  const MissionOutput output = mission.step(from_seconds(1.0), {}, NavigationFeedback::kDriving, std::nullopt);
  ASSERT_TRUE(output.task.goal);
  EXPECT_EQ(output.events.at(0).kind, EventKind::kMissionStarted);
  EXPECT_EQ(output.events.at(0).stamp, from_seconds(1.0));
}

// The settling time of odometry begins when it recognizes the standstill.
TEST(GasMission, StandsUntilTheFirstScanOfTheMapHasComeAfterItsStartWait) {
  GasMission mission(make_settings(), make_route());
  EXPECT_FALSE(mission.step(from_seconds(2.0), {.pose = {}, .awaits_first_scan = true}).task.goal);
  EXPECT_TRUE(mission.step(from_seconds(2.1), {.pose = {}, .awaits_first_scan = false}).task.goal);
}

// The registration moves the survey by 10 cm on the way to the first station, and again while it is measured there.
TEST(GasMission, StationsFollowTheSurveyButNotDuringAMeasurement) {
  GasMission mission(make_settings(), make_route());
  const auto moved_by = [](double shift_m) {
    Route route = make_route();
    for (Station& station : route.stations) station.T_route_body.x += shift_m;
    return route;
  };
  const auto step_at = [&](double time_s, NavigationFeedback feedback) {
    return mission.step(from_seconds(time_s), {.pose = {}, .navigation = feedback});
  };
  EXPECT_EQ(step_at(1.0, NavigationFeedback::kDriving).task.goal->T_map_body.x, 3.0);
  mission.set_site(moved_by(0.02));  // less than the minimum shift
  EXPECT_EQ(step_at(1.1, NavigationFeedback::kDriving).task.goal->T_map_body.x, 3.0);
  mission.set_site(moved_by(0.1));
  EXPECT_EQ(step_at(1.2, NavigationFeedback::kDriving).task.goal->T_map_body.x, 3.1);
  step_at(3.0, NavigationFeedback::kArrived);
  mission.set_site(moved_by(0.2));
  EXPECT_EQ(step_at(3.1, NavigationFeedback::kArrived).task.goal->T_map_body.x, 3.1);
  const MissionInput measured{.pose = {}, .inspection = {.feedback = InspectionFeedback::kDone}};
  EXPECT_EQ(mission.step(from_seconds(5.0), measured).task.goal->T_map_body.x, 3.2);  // the second station
}

// Reached at t, readings from t + 0.5 s on, for 1 s: measured at t + 1.5 s.
TEST(GasMission, MeasuresForItsTimeAfterSettling) {
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, clean_air);
  const Time reached = record.find(EventKind::kStationReached, "first").stamp;
  EXPECT_EQ(record.find(EventKind::kGasMeasured, "first").stamp - reached, from_seconds(1.5));
}

// Gas that blew past while the robot was still settling does not count.
TEST(GasMission, ReadingsBeforeItHasSettledDoNotCount) {
  int standing_ticks = 0;
  const Gas gas = [&](int, const Pose2& T_map_body) {
    if (T_map_body.x != 3.0 || T_map_body.y != 0.0) return 20.0;
    return ++standing_ticks <= 5 ? 10000.0 : 20.0;  // ticks 0 ... 4: the first 0.5 s
  };
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, gas);
  EXPECT_NEAR(record.find(EventKind::kGasMeasured, "first").value, 20.0, 1e-9);
  EXPECT_EQ(record.count(EventKind::kGasAlarm), 0);
}

TEST(GasMission, HoldsItsPlaceWhileItMeasures) {
  GasRound mission(make_settings(), make_route(), {});
  PoseEstimate pose;
  mission.step(from_seconds(1.0), pose, NavigationFeedback::kDriving, std::nullopt);
  const MissionOutput arrived = mission.step(from_seconds(2.0), pose, NavigationFeedback::kArrived, std::nullopt);
  EXPECT_EQ(arrived.events.at(0).kind, EventKind::kStationReached);
  const MissionOutput measuring = mission.step(from_seconds(2.1), pose, NavigationFeedback::kArrived, std::nullopt);
  ASSERT_TRUE(measuring.task.goal);
  EXPECT_EQ(measuring.task.goal->T_map_body.vector(), Eigen::Vector3d(3.0, 0.0, 0.0));
}

// Lost on the way to the first station for five seconds, and then while it is measured.
TEST(GasMission, StandsWhileLostAndMeasuresAgain) {
  GasMission mission(make_settings(), make_route());
  std::vector<EventKind> kinds;
  const auto step_at = [&](double time_s, bool is_lost, NavigationFeedback navigation) {
    MissionOutput output =
        mission.step(from_seconds(time_s), {.pose = {}, .is_lost = is_lost, .navigation = navigation});
    for (const Event& event : output.events) kinds.push_back(event.kind);
    return output.task;
  };
  EXPECT_FALSE(step_at(0.5, true, NavigationFeedback::kDriving).goal);  // it waits and needs no pose
  EXPECT_TRUE(kinds.empty());
  EXPECT_TRUE(step_at(1.0, false, NavigationFeedback::kDriving).goal);
  EXPECT_EQ(step_at(2.0, true, NavigationFeedback::kDriving).motion, Motion::kStand);
  EXPECT_FALSE(step_at(7.0, true, NavigationFeedback::kArrived).goal);
  EXPECT_EQ(step_at(7.1, false, NavigationFeedback::kDriving).motion, Motion::kNavigate);
  EXPECT_EQ(step_at(8.0, false, NavigationFeedback::kArrived).motion, Motion::kNavigate);
  EXPECT_TRUE(step_at(8.1, false, NavigationFeedback::kArrived).inspection);
  EXPECT_FALSE(step_at(8.2, true, NavigationFeedback::kArrived).inspection);
  EXPECT_FALSE(step_at(9.0, false, NavigationFeedback::kDriving).inspection);
  EXPECT_EQ(step_at(9.1, false, NavigationFeedback::kArrived).inspection->not_before, from_seconds(9.1));
  EXPECT_THAT(kinds, ElementsAre(EventKind::kMissionStarted, EventKind::kLocalizationLost, EventKind::kRelocalized,
                                 EventKind::kStationReached, EventKind::kLocalizationLost, EventKind::kRelocalized,
                                 EventKind::kStationReached));
}

TEST(GasMission, LostForLongerThanTheTimeoutFails) {
  GasMission mission(make_settings(), make_route());
  mission.step(from_seconds(1.0), {});
  const MissionInput lost{.pose = {}, .is_lost = true};
  mission.step(from_seconds(2.0), lost);
  mission.step(from_seconds(32.0), lost);
  EXPECT_FALSE(mission.is_over());
  const MissionOutput output = mission.step(from_seconds(32.1), lost);
  EXPECT_TRUE(mission.is_over());
  ASSERT_EQ(output.events.size(), 2U);
  EXPECT_EQ(output.events[0].kind, EventKind::kLocalizationFailed);
  EXPECT_EQ(output.events[1].text, "3 of 3 stations were skipped.");
}

// 150 and 250 in turn: mean 200 + m, the standard error of 11 readings is about 100 / 2 / sqrt(11) = 16: an
// alarm needs a mean of 232.
TEST(GasMission, AlarmsOnlyTwoStandardErrorsBeyondTheThreshold) {
  const auto with_mean = [](double mean) {
    return [mean](int tick, const Pose2&) { return mean + (tick % 2 == 0 ? 50.0 : -50.0); };
  };
  for (const double mean : {150.0, 200.0, 215.0, 225.0}) {
    GasRound mission(make_settings(), make_route(), {});
    EXPECT_EQ(run(mission, with_mean(mean)).count(EventKind::kGasAlarm), 0) << mean;
  }
  for (const double mean : {245.0, 300.0, 5000.0}) {
    GasRound mission(make_settings(), make_route(), {});
    const MissionRecord record = run(mission, with_mean(mean));
    EXPECT_EQ(record.count(EventKind::kGasAlarm), 2) << mean;  // at each station that measures
    EXPECT_NEAR(record.find(EventKind::kGasAlarm).value, mean, 5.0);
  }
}

}  // namespace
}  // namespace patrol::stack::gas_mission_test
