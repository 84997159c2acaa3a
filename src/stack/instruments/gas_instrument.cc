#include "stack/instruments/gas_instrument.h"

#include <algorithm>

#include <fmt/format.h>

namespace patrol::stack {

void GasInstrument::add(const SensorMessage& message, const StationPoseLookup&) {
  if (const auto* reading = std::get_if<GasReading>(&message)) newest_ = *reading;
}

void GasInstrument::begin(const InspectionOrder& order, Time) {
  order_ = order;
  measurement_ = {};
}

InspectionProgress GasInstrument::step(const InspectionContext& context) {
  const Time from = order_.not_before + from_seconds(rules_.settling_time_s);
  if (newest_ && newest_->stamp >= from) measurement_.add(*newest_);
  if (context.now >= from + from_seconds(rules_.measurement_duration_s) &&
      measurement_.count() >= rules_.min_readings) {
    report(context);
    return {.feedback = InspectionFeedback::kDone};
  }
  if (context.now < from + from_seconds(std::max(rules_.measurement_duration_s, rules_.measurement_timeout_s)))
    return {};
  return {.feedback = InspectionFeedback::kFailed,
          .failure = fmt::format("Too few methane readings: {} at {}, at least {} required.", measurement_.count(),
                                 order_.station, rules_.min_readings)};
}

void GasInstrument::report(const InspectionContext& context) const {
  const double column = measurement_.mean_ppm_m();
  const std::string& station = order_.station;
  context.publish_event(EventKind::kGasMeasured, station, fmt::format("{}: {:.0f} ppm m of methane.", station, column),
                        column, context.station_pose.T_map_body.position());
  if (column - 2.0 * measurement_.standard_error_ppm_m() <= rules_.alarm_column_ppm_m) return;
  const Eigen::Vector2d p_map = closest_point_on_beam(context.station_pose.T_map_body);
  context.publish_event(EventKind::kGasAlarm, station,
                        fmt::format("Leak at {}: {:.0f} ppm m of methane, found at ({:.2f}, {:.2f}) m in the map.",
                                    station, column, p_map.x(), p_map.y()),
                        column, p_map);
}

/// Returns the point on the beam nearest to the target, because the reading does not constrain the gas position along
/// the beam.
Eigen::Vector2d GasInstrument::closest_point_on_beam(const Pose2& T_map_body) const {
  const auto to_map = [&](const Eigen::Vector3d& p_body) { return T_map_body * Eigen::Vector2d(p_body.head<2>()); };
  const Eigen::Vector2d from = to_map(T_body_gas_.position);
  const Eigen::Vector2d direction = (to_map(T_body_gas_ * Eigen::Vector3d::UnitX().eval()) - from).normalized();
  const Eigen::Vector2d to_target = order_.p_map_target - from;
  return from + std::clamp(to_target.dot(direction), 0.0, measurement_.beam_m().value_or(to_target.norm())) * direction;
}

}  // namespace patrol::stack
