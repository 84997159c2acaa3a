#include "stack/mission/gas_mission.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/text.h"

namespace patrol::stack {
namespace {

constexpr double kMinStationShift_m = 0.05;  // minimum shift of the station that the robot is driving to

}  // namespace

GasRules gas_rules(const GasMissionSettings& settings) {
  return {.settling_time_s = settings.settling_time_s,
          .measurement_duration_s = settings.measurement_duration_s,
          .measurement_timeout_s = settings.measurement_timeout_s,
          .min_readings = settings.min_readings,
          .alarm_column_ppm_m = settings.alarm_column_ppm_m};
}

GasMission::GasMission(const GasMissionSettings& settings, Route route_in_map, std::string order_text)
    : settings_(settings),
      route_(std::move(route_in_map)),
      order_text_(std::move(order_text)),
      localization_(settings.relocalization_timeout_s) {
  validate(settings, "gas_mission");
  if (route_.stations.empty()) throw InputError("route: has no stations: must have at least one");
}

MissionOutput GasMission::step(Time now, const MissionInput& input) {
  now_ = now;
  T_map_body_ = input.pose.T_map_body;
  MissionOutput output;
  if (monitor_localization(input, output)) return output;
  switch (phase_) {
    case Phase::kWaiting:
      wait(input, output);
      break;
    case Phase::kDriving:
      drive(input.navigation, output);
      break;
    case Phase::kMeasuring:
      measure(input.inspection, output);
      break;
    case Phase::kOver:
      break;
  }
  output.task = task();
  return output;
}

void GasMission::set_site(const Route& site_in_map) {
  for (std::size_t i = current_; i < route_.stations.size(); ++i) {
    Station& mine = route_.stations[i];
    const auto moved = std::ranges::find(site_in_map.stations, mine.name, &Station::name);
    if (moved == site_in_map.stations.end()) continue;
    const double shift_m = (moved->T_route_body.position() - mine.T_route_body.position()).norm();
    const bool is_present = i == current_ && phase_ != Phase::kWaiting;
    if (is_present && (phase_ != Phase::kDriving || shift_m < kMinStationShift_m)) continue;
    mine.T_route_body = moved->T_route_body;
    mine.p_route_target = moved->p_route_target;
  }
}

/// Keeps the goal while measuring, so that the robot holds its pose.
Task GasMission::task() const {
  Task task;
  if (phase_ == Phase::kDriving || phase_ == Phase::kMeasuring) {
    task.motion = Motion::kNavigate;
    task.goal = goal_at(station());
  }
  if (phase_ == Phase::kMeasuring) {
    task.inspection = InspectionOrder{.instrument = InstrumentKind::kGas,
                                      .station = station().name,
                                      .not_before = phase_start_,
                                      .p_map_target = station().p_route_target.head<2>()};
  }
  return task;
}

Event GasMission::abort(Time now, EventKind kind, const std::string& text) {
  now_ = now;
  phase_ = Phase::kOver;
  return event(kind, current_ < route_.stations.size() ? station().name : "", text);
}

/// Returns whether the robot stands still because localization is lost.
bool GasMission::monitor_localization(const MissionInput& input, MissionOutput& output) {
  const bool needs_pose = phase_ == Phase::kDriving || phase_ == Phase::kMeasuring;
  const auto status = localization_.step(now_, input.is_lost && needs_pose, T_map_body_, output.events);
  if (status == LocalizationMonitor::Status::kUsable) return false;
  if (status == LocalizationMonitor::Status::kFailed) {
    num_failed_ += static_cast<int>(route_.stations.size() - current_);
    finish(output);
  } else {
    phase_ = Phase::kDriving;
    phase_start_ = now_;
  }
  return true;
}

void GasMission::wait(const MissionInput& input, MissionOutput& output) {
  if (now_ < from_seconds(settings_.init_wait_s) || input.awaits_first_scan) return;
  const std::vector<std::string> names = route_.station_names();
  const std::string stations = fmt::format("Mission started: {} stations, {}.", names.size(), join(names, ", "));
  output.events.push_back(
      event(EventKind::kMissionStarted, "", order_text_.empty() ? stations : stations + " " + order_text_));
  phase_ = Phase::kDriving;
  phase_start_ = now_;
}

void GasMission::drive(NavigationFeedback feedback, MissionOutput& output) {
  if (now_ == phase_start_) return;  // the feedback is for the previous goal
  if (feedback == NavigationFeedback::kFailed) {
    ++num_failed_;
    output.events.push_back(
        event(EventKind::kStationFailed, station().name, fmt::format("{} is unreachable.", station().name)));
    return next_station(output);
  }
  if (feedback != NavigationFeedback::kArrived) return;
  output.events.push_back(event(EventKind::kStationReached, station().name, fmt::format("At {}.", station().name)));
  if (const double late_s = to_seconds(now_) - station().latest_s; late_s > 0.0) {
    output.events.push_back(event(EventKind::kStationLate, station().name,
                                  fmt::format("{:.0f} s late at {}.", late_s, station().name), late_s));
  }
  if (station().type != StationType::kInspect) return next_station(output);
  phase_ = Phase::kMeasuring;
  phase_start_ = std::max(now_, from_seconds(station().earliest_s));
}

void GasMission::measure(const InspectionProgress& progress, MissionOutput& output) {
  if (progress.feedback == InspectionFeedback::kInProgress) return;
  if (progress.feedback == InspectionFeedback::kFailed) {
    ++num_failed_;
    output.events.push_back(event(EventKind::kStationFailed, station().name, progress.failure));
  }
  next_station(output);
}

void GasMission::next_station(MissionOutput& output) {
  ++current_;
  phase_start_ = now_;
  if (current_ < route_.stations.size()) {
    phase_ = Phase::kDriving;
    return;
  }
  finish(output);
}

void GasMission::finish(MissionOutput& output) {
  phase_ = Phase::kOver;
  if (num_failed_ == 0) {
    const bool inspects =
        std::ranges::find(route_.stations, StationType::kInspect, &Station::type) != route_.stations.end();
    output.events.push_back(event(EventKind::kMissionCompleted, "",
                                  inspects ? "Every station was inspected." : "Every station was reached."));
  } else {
    output.events.push_back(event(EventKind::kMissionFailed, "",
                                  fmt::format("{} of {} stations were skipped.", num_failed_, route_.stations.size())));
  }
}

NavigationGoal GasMission::goal_at(const Station& station) const {
  NavigationGoal goal{.T_map_body = station.T_route_body,
                      .position_tolerance_m = std::min(settings_.position_tolerance_m, station.accuracy_m),
                      .yaw_tolerance_rad = settings_.yaw_tolerance_rad};
  if (station.type == StationType::kPass) {
    goal.position_tolerance_m = station.accuracy_m;
    goal.yaw_tolerance_rad = std::numbers::pi;
  }
  return goal;
}

Event GasMission::event(EventKind kind, const std::string& subject, const std::string& text, double value) const {
  return {.stamp = now_,
          .kind = kind,
          .subject = subject,
          .text = text,
          .value = value,
          .T_map_body = T_map_body_,
          .p_map_target = T_map_body_.position()};
}

}  // namespace patrol::stack
