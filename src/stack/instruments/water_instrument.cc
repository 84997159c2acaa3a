#include "stack/instruments/water_instrument.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace patrol::stack {

WaterInstrument::WaterInstrument(const inspect::WaterSettings& settings, AntennaGeometry antenna, std::uint64_t seed)
    : settings_(settings), geometry_(std::move(antenna)), inversion_(settings), seed_(seed) {}

void WaterInstrument::add(const SensorMessage& message, const StationPoseLookup&) {
  if (const auto* state = std::get_if<AntennaState>(&message)) antenna_ = *state;
  if (const auto* sounding = std::get_if<TemSounding>(&message)) new_sounding_ = *sounding;
}

void WaterInstrument::begin(const InspectionOrder& order, Time now) {
  station_ = order.station;
  new_sounding_.reset();
  sounding_.emplace(settings_.sounding, geometry_, now);
}

InspectionProgress WaterInstrument::step(const InspectionContext& context) {
  const auto command = sounding_->step(context.now, antenna_, std::exchange(new_sounding_, std::nullopt));
  if (command) std::visit([&](const auto& order) { context.output.publish(order); }, *command);
  if (!sounding_->is_over()) return {};
  if (!sounding_->is_stowed() || sounding_->soundings().empty()) return {.feedback = InspectionFeedback::kFailed};
  WaterResult result = estimate(context);
  report(context, result);
  context.output.publish(std::move(result));
  return {.feedback = sounding_->num_skipped() == 0 ? InspectionFeedback::kDone : InspectionFeedback::kFailed};
}

WaterResult WaterInstrument::estimate(const InspectionContext& context) const {
  const StationPose& station_pose = context.station_pose;
  AntennaGeometry antenna = geometry_;  // antenna with the tilt of the standing robot
  antenna.T_body_mount = Pose3{Eigen::Vector3d::Zero(), station_pose.T_level_body.rotation} * antenna.T_body_mount;
  WaterResult result = inversion_.invert(sounding_->soundings(), antenna, station_pose.T_map_body,
                                         sounding_->antenna_error_deg(), seed_);
  result.stamp = context.now;
  result.station = station_;
  return result;
}

void WaterInstrument::report(const InspectionContext& context, const WaterResult& result) const {
  if (!result.is_found) {
    context.publish_event(EventKind::kWaterNotFound, station_,
                          fmt::format("No water ahead: {} soundings.", result.soundings), 0.0,
                          context.station_pose.T_map_body.position());
    return;
  }
  context.publish_event(water_event(result.level), station_,
                        fmt::format("Water ahead, {:.1f} m from the antenna ({:.1f} to {:.1f} m), {:.0f} degrees to "
                                    "the {}: a body {:.1f} m across ({:.1f} to {:.1f} m).",
                                    result.distance_m, result.distance_low_m, result.distance_high_m,
                                    std::abs(result.azimuth_deg), result.azimuth_deg >= 0.0 ? "left" : "right",
                                    2.0 * result.radius_m, 2.0 * result.radius_low_m, 2.0 * result.radius_high_m),
                        result.distance_m, result.p_map.head<2>());
  context.light.warn(context.now, result.level, context.output);
}

}  // namespace patrol::stack
