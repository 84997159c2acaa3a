#include "stack/mission/gas_mission.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "stack/instruments/instrument_set.h"
#include "tests/support/pose_near.h"

namespace patrol::stack::gas_mission_test {
namespace {

using std::numbers::pi;
using test::VectorNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kPeriod_s = 0.1;

Station make_station(const std::string& name, const Pose2& T_route_body, StationType type = StationType::kInspect) {
  Station station;
  station.name = name;
  station.type = type;
  station.T_route_body = T_route_body;
  const Eigen::Vector2d target = T_route_body * Eigen::Vector2d(2.0, 0.0);  // straight ahead
  station.p_route_target = {target.x(), target.y(), 1.0};
  return station;
}

Route make_route() {
  Route route;
  route.stations = {make_station("first", {3.0, 0.0, 0.0}), make_station("second", {3.0, 4.0, pi / 2.0}),
                    make_station("home", {0.0, 0.0, 0.0}, StationType::kHome)};
  return route;
}

/// A second of waiting, half of settling, one of readings at 10 Hz.
GasMissionSettings make_settings() {
  GasMissionSettings settings;
  settings.init_wait_s = 1.0;
  settings.settling_time_s = 0.5;
  settings.measurement_duration_s = 1.0;
  settings.measurement_timeout_s = 3.0;
  settings.min_readings = 5;
  settings.alarm_column_ppm_m = 200.0;
  return settings;
}

/// A gas mission with its instrument, in the order of a control period: the instrument works on the task of the period
/// before.
class GasRound {
 public:
  GasRound(const GasMissionSettings& settings, Route route, const Pose3& T_body_gas, std::string order_text = "")
      : mission_(settings, std::move(route), std::move(order_text)),
        instruments_(gas_meter(settings, T_body_gas), 1.0) {}

  MissionOutput step(Time now, const PoseEstimate& pose, NavigationFeedback feedback,
                     const std::optional<GasReading>& newest_gas) {
    if (newest_gas) instruments_.add(*newest_gas, nullptr);
    const InspectionProgress progress =
        instruments_.step(now, task_.inspection, {.T_level_body = {}, .T_map_body = pose.T_map_body}, output_);
    MissionOutput output = mission_.step(now, {.pose = pose, .navigation = feedback, .inspection = progress});
    std::vector<Event> events;
    for (const StackMessage& message : output_.take_messages()) events.push_back(std::get<Event>(message));
    output.events.insert(output.events.begin(), events.begin(), events.end());
    task_ = output.task;
    return output;
  }
  bool is_over() const { return mission_.is_over(); }
  Event abort(Time now, EventKind kind, const std::string& text) { return mission_.abort(now, kind, text); }

 private:
  static std::vector<std::unique_ptr<Instrument>> gas_meter(const GasMissionSettings& settings,
                                                            const Pose3& T_body_gas) {
    std::vector<std::unique_ptr<Instrument>> instruments;
    instruments.push_back(std::make_unique<GasInstrument>(gas_rules(settings), T_body_gas));
    return instruments;
  }

  GasMission mission_;
  InstrumentSet instruments_;
  StackOutput output_;
  Task task_;
};

/// What the mission did.
struct MissionRecord {
  std::vector<Event> events;
  std::vector<EventKind> kinds() const {
    std::vector<EventKind> kinds;
    for (const Event& event : events) kinds.push_back(event.kind);
    return kinds;
  }
  const Event& find(EventKind kind, const std::string& subject = "") const {
    for (const Event& event : events) {
      if (event.kind == kind && (subject.empty() || event.subject == subject)) return event;
    }
    throw std::logic_error("no event " + std::string(name_of(kind)));
  }
  int count(EventKind kind) const {
    return static_cast<int>(
        std::count_if(events.begin(), events.end(), [&](const Event& e) { return e.kind == kind; }));
  }
};

/// The column that the instrument reads at a tick while the robot stands somewhere; NaN: no reading.
using Gas = std::function<double(int tick, const Pose2& T_map_body)>;

constexpr double kBeam_m = 2.5;

/// Runs a mission with a navigation that needs two seconds to every goal, or cannot reach it.
MissionRecord run(GasRound& mission, const Gas& gas,
                  const std::function<bool(const NavigationGoal&)>& is_reachable = nullptr,
                  double time_limit_s = 120.0) {
  MissionRecord record;
  PoseEstimate pose;
  std::optional<NavigationGoal> goal;
  double goal_since_s = 0.0;
  std::optional<GasReading> newest_gas;
  for (int tick = 0; kPeriod_s * tick < time_limit_s && !mission.is_over(); ++tick) {
    const double time_s = kPeriod_s * tick;
    pose.stamp = from_seconds(time_s);
    NavigationFeedback feedback = NavigationFeedback::kDriving;
    if (goal && time_s >= goal_since_s + 2.0) {
      const bool is_there = !is_reachable || is_reachable(*goal);
      feedback = is_there ? NavigationFeedback::kArrived : NavigationFeedback::kFailed;
      if (is_there) pose.T_map_body = goal->T_map_body;
    }
    const double column = gas(tick, pose.T_map_body);
    if (!std::isnan(column)) {
      newest_gas = GasReading{.stamp = pose.stamp, .column_ppm_m = column, .path_length_m = kBeam_m, .mean_mg_m3 = 0.0};
    }
    const MissionOutput output = mission.step(pose.stamp, pose, feedback, newest_gas);
    record.events.insert(record.events.end(), output.events.begin(), output.events.end());
    if (output.task.goal != goal) goal_since_s = time_s;
    goal = output.task.goal;
  }
  return record;
}

double clean_air(int, const Pose2&) { return 20.0; }

TEST(GasMission, WalksMeasuresAndCompletesInOrder) {
  GasRound mission(make_settings(), make_route(), {});
  const MissionRecord record = run(mission, clean_air);
  EXPECT_THAT(record.kinds(), ElementsAre(EventKind::kMissionStarted, EventKind::kStationReached,
                                          EventKind::kGasMeasured, EventKind::kStationReached, EventKind::kGasMeasured,
                                          EventKind::kStationReached, EventKind::kMissionCompleted));
  EXPECT_EQ(record.events[1].subject, "first");
  EXPECT_EQ(record.events[3].subject, "second");
  EXPECT_EQ(record.events[5].subject, "home");  // nothing is measured there
  EXPECT_TRUE(mission.is_over());
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

}  // namespace
}  // namespace patrol::stack::gas_mission_test
