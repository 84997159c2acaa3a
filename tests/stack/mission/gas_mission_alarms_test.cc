#include <limits>

#include "stack/mission/gas_mission.h"
#include "tests/stack/mission/gas_mission_parts.h"

namespace patrol::stack::gas_mission_test {
namespace {

// Clean air must not alarm: over 500 stations at 80 ppm m below the threshold with a reading's deviation of
// 60 ppm m, none may.
TEST(GasMission, NeverAlarmsInFiveHundredStationsOfCleanAir) {
  Route route;
  for (int i = 0; i < 500; ++i) route.stations.push_back(make_station(fmt::format("s{}", i), {1.0 * i, 0.0, 0.0}));
  const RandomStream stream(11, "test/air");
  GasRound mission(make_settings(), route, {});
  const MissionRecord record = run(
      mission, [&](int tick, const Pose2&) { return 120.0 + 60.0 * stream.normal(static_cast<std::uint64_t>(tick)); },
      nullptr, 1e5);
  EXPECT_EQ(record.count(EventKind::kGasMeasured), 500);
  EXPECT_EQ(record.count(EventKind::kGasAlarm), 0);
}

TEST(GasMission, AlarmNamesTheStationWithTheLeak) {
  const Gas gas = [](int, const Pose2& T_map_body) { return T_map_body.y > 1.0 ? 900.0 : 20.0; };
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, gas);
  ASSERT_EQ(record.count(EventKind::kGasAlarm), 1);
  EXPECT_EQ(record.find(EventKind::kGasAlarm).subject, "second");
  EXPECT_THAT(record.find(EventKind::kGasAlarm).text, HasSubstr("900 ppm m"));
}

// The meter sits 0.3 m before the body's origin at (3, 4) and looks north with the robot; the target lies at
// (3, 6), on the beam.
TEST(GasMission, PlacesTheLeakOnTheBeamAtTheTarget) {
  const Gas gas = [](int, const Pose2& T_map_body) { return T_map_body.y > 1.0 ? 900.0 : 20.0; };
  GasRound mission(make_settings(), make_route(), {.position = {0.3, 0.0, 0.2}});
  const MissionRecord record = run(mission, gas);
  EXPECT_THAT(record.find(EventKind::kGasAlarm).p_map_target, VectorNear(Eigen::Vector2d(3.0, 6.0), 1e-9));
}

// The same with the target moved: 1 m aside, its foot on the beam; 9 m away, the beam's end 2.5 m from the
// meter; behind, the meter.
TEST(GasMission, PlacesTheLeakOnTheBeamWhereItIsNearestToTheTarget) {
  const struct {
    Eigen::Vector2d target, expected;
  } cases[] = {{{1.0, 1.0}, {1.0, 0.0}}, {{9.0, 1.0}, {0.3 + kBeam_m, 0.0}}, {{-4.0, 1.0}, {0.3, 0.0}}};
  for (const auto& [target, expected] : cases) {
    Route route;
    route.stations = {make_station("only", {0.0, 0.0, 0.0})};
    route.stations[0].p_route_target = {target.x(), target.y(), 0.0};
    GasRound mission(make_settings(), route, {.position = {0.3, 0.0, 0.2}});
    const MissionRecord record = run(mission, [](int, const Pose2&) { return 900.0; });
    EXPECT_THAT(record.find(EventKind::kGasAlarm).p_map_target, VectorNear(expected, 1e-9)) << target.transpose();
  }
}

TEST(GasMission, ABeamTurnedToTheLeftPlacesTheLeakOnTheLeft) {
  Route route;
  route.stations = {make_station("only", {0.0, 0.0, 0.0})};
  route.stations[0].p_route_target = {0.0, 2.0, 0.0};
  GasRound mission(make_settings(), route, {.rotation = quaternion_from_yaw(pi / 2.0)});
  const MissionRecord record = run(mission, [](int, const Pose2&) { return 900.0; });
  EXPECT_THAT(record.find(EventKind::kGasAlarm).p_map_target, VectorNear(Eigen::Vector2d(0.0, 2.0), 1e-9));
}

TEST(GasMission, AStationOutOfReachIsLeftOutAndTheMissionFails) {
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record =
      run(mission, clean_air, [](const NavigationGoal& goal) { return goal.T_map_body.y < 1.0; });  // not "second"
  EXPECT_THAT(record.kinds(),
              ElementsAre(EventKind::kMissionStarted, EventKind::kStationReached, EventKind::kGasMeasured,
                          EventKind::kStationFailed, EventKind::kStationReached, EventKind::kMissionFailed));
  EXPECT_EQ(record.find(EventKind::kStationFailed).subject, "second");
  EXPECT_THAT(record.find(EventKind::kMissionFailed).text, HasSubstr("1 of 3 stations"));
}

// Settled after 0.5 s, given up 3 s later.
TEST(GasMission, AStationWithoutReadingsIsGivenUpAfterItsLimit) {
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, [](int, const Pose2&) { return std::nan(""); });
  EXPECT_EQ(record.count(EventKind::kStationFailed), 2);
  EXPECT_EQ(record.count(EventKind::kGasMeasured), 0);
  EXPECT_EQ(record.find(EventKind::kStationFailed).stamp - record.find(EventKind::kStationReached).stamp,
            from_seconds(3.5));
  EXPECT_EQ(record.events.back().kind, EventKind::kMissionFailed);
}

TEST(GasMission, WaitsLongerForASlowInstrument) {
  // A reading every 0.5 s: five of them take 2 s.
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, [](int tick, const Pose2&) { return tick % 5 == 0 ? 30.0 : std::nan(""); });
  EXPECT_EQ(record.count(EventKind::kGasMeasured), 2);
  const Time taken = record.find(EventKind::kGasMeasured).stamp - record.find(EventKind::kStationReached).stamp;
  EXPECT_GT(taken, from_seconds(2.0));
  EXPECT_LE(taken, from_seconds(3.0));
}

TEST(GasMission, AskedPrecisionIsTheFinerOfSettingAndSurvey) {
  Route route = make_route();
  route.stations[0].accuracy_m = 0.02;
  route.stations[1].accuracy_m = 0.5;
  GasMissionSettings settings = make_settings();
  settings.position_tolerance_m = 0.08;
  settings.yaw_tolerance_rad = 0.06;
  std::vector<NavigationGoal> goals;
  GasRound mission(settings, route, {});
  run(mission, clean_air, [&](const NavigationGoal& goal) {
    if (goals.empty() || !(goals.back() == goal)) goals.push_back(goal);
    return true;
  });
  ASSERT_EQ(goals.size(), 3u);
  EXPECT_EQ(goals[0].position_tolerance_m, 0.02);
  EXPECT_EQ(goals[1].position_tolerance_m, 0.08);
  EXPECT_EQ(goals[1].yaw_tolerance_rad, 0.06);
}

TEST(GasMission, APlaceToPassAsksForNoHeading) {
  Route route;
  route.stations = {make_station("gate", {1.0, 0.0, 0.0}, StationType::kPass)};
  route.stations[0].accuracy_m = 0.6;
  GasRound mission(make_settings(), route, {});
  const MissionOutput output = mission.step(from_seconds(1.0), {}, NavigationFeedback::kDriving, std::nullopt);
  ASSERT_TRUE(output.task.goal);
  EXPECT_EQ(output.task.goal->position_tolerance_m, 0.6);
  EXPECT_EQ(output.task.goal->yaw_tolerance_rad, pi);
}

// In the step in which the goal changes, navigation still speaks of the one before.
TEST(GasMission, FeedbackAboutTheGoalBeforeDoesNotCount) {
  GasRound mission(make_settings(), make_route(), {});
  const MissionOutput first = mission.step(from_seconds(1.0), {}, NavigationFeedback::kArrived, std::nullopt);
  EXPECT_EQ(first.events.size(), 1u);
  const MissionOutput same_instant = mission.step(from_seconds(1.0), {}, NavigationFeedback::kArrived, std::nullopt);
  EXPECT_TRUE(same_instant.events.empty());
}

TEST(GasMission, AbortEndsItWithItsEvent) {
  GasRound mission(make_settings(), make_route(), {});
  mission.step(from_seconds(1.0), {}, NavigationFeedback::kDriving, std::nullopt);
  const Event fall = mission.abort(from_seconds(1.5), EventKind::kFall, "The robot fell.");
  EXPECT_EQ(fall.kind, EventKind::kFall);
  EXPECT_EQ(fall.subject, "first");
  EXPECT_EQ(fall.stamp, from_seconds(1.5));
  EXPECT_TRUE(mission.is_over());
  const MissionOutput after = mission.step(from_seconds(2.0), {}, NavigationFeedback::kArrived, std::nullopt);
  EXPECT_FALSE(after.task.goal);
  EXPECT_TRUE(after.events.empty());
}

TEST(GasMission, EventsSayWhereTheRobotWas) {
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, clean_air);
  EXPECT_EQ(record.find(EventKind::kGasMeasured, "second").T_map_body.vector(), Eigen::Vector3d(3.0, 4.0, pi / 2.0));
}

TEST(GasMission, RefusesAnEmptyRouteAndSettingsThatBreakTheirRule) {
  EXPECT_THAT([] { GasRound(make_settings(), {}, {}); }, ::testing::ThrowsMessage<InputError>(HasSubstr("no station")));
  GasMissionSettings settings = make_settings();
  settings.min_readings = 0;
  EXPECT_THAT([&] { GasRound(settings, make_route(), {}); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("gas_mission.min_readings = 0")));
}

TEST(GasMission, ReadingsWithoutAReturnAreNoReadings) {
  GasRound mission(make_settings(), make_route(), {});
  MissionOutput output;
  for (int tick = 10; tick < 60; ++tick) {
    const Time now = from_seconds(kPeriod_s * tick);
    const GasReading dark{.stamp = now, .path_length_m = std::numeric_limits<double>::infinity()};
    output = mission.step(now, {}, tick < 20 ? NavigationFeedback::kDriving : NavigationFeedback::kArrived, dark);
    for (const Event& event : output.events) EXPECT_NE(event.kind, EventKind::kGasMeasured);
    if (tick > 20 && !output.events.empty()) break;
  }
  ASSERT_FALSE(output.events.empty());
  EXPECT_EQ(output.events[0].kind, EventKind::kStationFailed);
  EXPECT_EQ(output.events[0].text, "Too few methane readings: 0 at first, at least 5 required.");
}

}  // namespace
}  // namespace patrol::stack::gas_mission_test
