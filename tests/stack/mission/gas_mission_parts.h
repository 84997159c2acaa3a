#pragma once

#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "stack/instruments/instrument_set.h"
#include "stack/mission/gas_mission.h"
#include "tests/support/pose_near.h"

namespace patrol::stack::gas_mission_test {

using std::numbers::pi;
using test::VectorNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kPeriod_s = 0.1;

inline Station make_station(const std::string& name, const Pose2& T_route_body,
                            StationType type = StationType::kInspect) {
  Station station;
  station.name = name;
  station.type = type;
  station.T_route_body = T_route_body;
  const Eigen::Vector2d target = T_route_body * Eigen::Vector2d(2.0, 0.0);  // straight ahead
  station.p_route_target = {target.x(), target.y(), 1.0};
  return station;
}

inline Route make_route() {
  Route route;
  route.stations = {make_station("first", {3.0, 0.0, 0.0}), make_station("second", {3.0, 4.0, pi / 2.0}),
                    make_station("home", {0.0, 0.0, 0.0}, StationType::kHome)};
  return route;
}

/// A second of waiting, half of settling, one of readings at 10 Hz.
inline GasMissionSettings make_settings() {
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

/// Record of the mission.
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
inline MissionRecord run(GasRound& mission, const Gas& gas,
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

inline double clean_air(int, const Pose2&) { return 20.0; }

}  // namespace patrol::stack::gas_mission_test
