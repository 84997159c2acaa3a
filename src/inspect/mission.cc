#include "inspect/mission.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace patrol::inspect {

Mission::Mission(const MissionSettings& settings, Route route_in_map, const Pose3& T_body_gas, std::string about_order)
    : settings_(settings), route_(std::move(route_in_map)), T_body_gas_(T_body_gas), about_order_(std::move(about_order)) {
  validate(settings, "mission");
  if (route_.stations.empty()) throw InputError("the route has no station");
}

MissionOutput Mission::step(Time now, const PoseEstimate& pose, NavigationFeedback feedback,
                            const std::optional<GasReading>& newest_gas) {
  now_ = now;
  T_map_body_ = pose.T_map_body;
  MissionOutput output;
  switch (phase_) {
    case Phase::kWaiting:
      wait(output);
      break;
    case Phase::kDriving:
      drive(feedback, output);
      break;
    case Phase::kMeasuring:
      measure(newest_gas, output);
      break;
    case Phase::kOver:
      break;
  }
  // While measuring, the goal stays: the robot holds its place.
  if (phase_ == Phase::kDriving || phase_ == Phase::kMeasuring) output.goal = goal_at(station());
  return output;
}

Event Mission::abort(Time now, EventKind kind, const std::string& text) {
  now_ = now;
  phase_ = Phase::kOver;
  return event(kind, current_ < route_.stations.size() ? station().name : "", text);
}

void Mission::wait(MissionOutput& output) {
  if (now_ < from_seconds(settings_.start_wait_s)) return;
  std::vector<std::string> names;
  for (const Station& station : route_.stations) names.push_back(station.name);
  const std::string stations = fmt::format("The mission starts: {} stations, {}.", names.size(), fmt::join(names, ", "));
  output.events.push_back(event(EventKind::kMissionStarted, "", about_order_.empty() ? stations : stations + " " + about_order_));
  phase_ = Phase::kDriving;
  phase_start_ = now_;
}

void Mission::drive(NavigationFeedback feedback, MissionOutput& output) {
  if (now_ == phase_start_) return;  // the feedback is about the goal before
  if (feedback == NavigationFeedback::kFailed) {
    ++num_failed_;
    output.events.push_back(event(EventKind::kStationFailed, station().name, fmt::format("No way to {}.", station().name)));
    return next_station(output);
  }
  if (feedback != NavigationFeedback::kArrived) return;
  output.events.push_back(event(EventKind::kStationReached, station().name, fmt::format("At {}.", station().name)));
  if (const double late_s = to_seconds(now_) - station().latest_s; late_s > 0.0) {
    output.events.push_back(event(EventKind::kStationLate, station().name, fmt::format("{:.0f} s late at {}.", late_s, station().name), late_s));
  }
  if (station().type != StationType::kInspect) return next_station(output);
  phase_ = Phase::kMeasuring;
  phase_start_ = std::max(now_, from_seconds(station().earliest_s));
  gas_ = {};
}

void Mission::measure(const std::optional<GasReading>& newest_gas, MissionOutput& output) {
  const Time from = phase_start_ + from_seconds(settings_.settle_s);
  if (newest_gas && newest_gas->stamp >= from) gas_.add(*newest_gas);
  const bool is_enough = now_ >= from + from_seconds(settings_.measure_s) && gas_.count() >= settings_.min_readings;
  if (is_enough) {
    report_gas(output);
    next_station(output);
  } else if (now_ >= from + from_seconds(std::max(settings_.measure_s, settings_.max_measure_s))) {
    ++num_failed_;
    output.events.push_back(event(EventKind::kStationFailed, station().name,
                                  fmt::format("The methane meter gave {} readings at {}, {} are needed.", gas_.count(),
                                              station().name, settings_.min_readings)));
    next_station(output);
  }
}

void Mission::report_gas(MissionOutput& output) {
  const double column = gas_.mean_ppm_m();
  output.events.push_back(event(EventKind::kGasMeasured, station().name,
                                fmt::format("{}: {:.0f} ppm m of methane.", station().name, column), column));
  if (column - 2.0 * gas_.standard_error_ppm_m() <= settings_.alarm_column_ppm_m) return;
  Event alarm = event(EventKind::kGasAlarm, station().name, "", column);
  alarm.p_map_target = place_on_beam();
  alarm.text = fmt::format("Leak at {}: {:.0f} ppm m of methane, found at ({:.2f}, {:.2f}) m in the map.", station().name,
                           column, alarm.p_map_target.x(), alarm.p_map_target.y());
  output.events.push_back(alarm);
}

/// The beam does not tell where along it the gas is: the point of it that is nearest to what was inspected.
Eigen::Vector2d Mission::place_on_beam() const {
  const auto to_map = [this](const Eigen::Vector3d& p_body) { return T_map_body_ * Eigen::Vector2d(p_body.head<2>()); };
  const Eigen::Vector2d from = to_map(T_body_gas_.position);
  const Eigen::Vector2d direction = (to_map(T_body_gas_ * Eigen::Vector3d::UnitX().eval()) - from).normalized();
  const Eigen::Vector2d to_target = station().p_route_target.head<2>() - from;
  return from + std::clamp(to_target.dot(direction), 0.0, gas_.beam_m().value_or(to_target.norm())) * direction;
}

void Mission::next_station(MissionOutput& output) {
  ++current_;
  phase_start_ = now_;
  if (current_ < route_.stations.size()) {
    phase_ = Phase::kDriving;
    return;
  }
  phase_ = Phase::kOver;
  if (num_failed_ == 0) {
    output.events.push_back(event(EventKind::kMissionCompleted, "", "Every station was inspected."));
  } else {
    output.events.push_back(event(EventKind::kMissionFailed, "", fmt::format("{} of {} stations were left out.", num_failed_, route_.stations.size())));
  }
}

NavigationGoal Mission::goal_at(const Station& station) const {
  NavigationGoal goal{.T_map_body = station.T_route_body,
                      .position_tol_m = std::min(settings_.position_tol_m, station.accuracy_m),
                      .yaw_tol_rad = settings_.yaw_tol_rad};
  if (station.type == StationType::kPass) {
    goal.position_tol_m = station.accuracy_m;
    goal.yaw_tol_rad = std::numbers::pi;
  }
  return goal;
}

Event Mission::event(EventKind kind, const std::string& subject, const std::string& text, double value) const {
  return {.stamp = now_, .kind = kind, .subject = subject, .text = text, .value = value, .T_map_body = T_map_body_,
          .p_map_target = T_map_body_.position()};
}

}  // namespace patrol::inspect
