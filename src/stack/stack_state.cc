#include "core/state/message_state.h"
#include "localize/localize_state.h"
#include "stack/instruments/gas_instrument.h"
#include "stack/instruments/lining_instrument.h"
#include "stack/instruments/water_instrument.h"
#include "stack/localization/delayed_localizer.h"
#include "stack/localization/known_map_localizer.h"
#include "stack/localization/map_then_localize.h"
#include "stack/localization/slam_localizer.h"
#include "stack/mission/gas_mission.h"
#include "stack/mission/tunnel_mission.h"
#include "stack/stack.h"

namespace patrol::stack {

void Stack::serialize_state(StateArchive& archive) {
  archive.section("stack");
  archive(parts_.pose, parts_.motion, parts_.mission, parts_.instruments, parts_.sensor_monitor, parts_.dock,
          parts_.site);
  archive(output_, task_, inspection_, new_teleop_, command_, next_control_, next_odometry_, next_map_);
}

void GasMission::serialize_state(StateArchive& archive) {
  archive.section("gas mission");
  archive(route_, phase_, current_, num_failed_, phase_start_, localization_, now_, T_map_body_);
}

void TunnelMission::serialize_state(StateArchive& archive) {
  archive.section("tunnel mission");
  archive(goals_, saved_, has_map_, is_docked_, phase_, first_step_, phase_start_, last_teleop_, run_, goal_,
          num_soundings_, num_failed_, localization_, now_, T_map_body_);
}

void GasInstrument::serialize_state(StateArchive& archive) { archive(order_, newest_, measurement_); }

void LiningInstrument::serialize_state(StateArchive& archive) {
  archive(references_, station_, order_start_, is_active_, has_requested_scan_, new_scan_);
}

void WaterInstrument::serialize_state(StateArchive& archive) {
  archive(station_, antenna_, new_sounding_);
  bool has_sounding = sounding_.has_value();
  archive(has_sounding);
  if (!has_sounding) sounding_.reset();
  if (has_sounding && !sounding_) sounding_.emplace(settings_.sounding, geometry_, Time{});
  archive.part(sounding_);
}

void DelayedLocalizer::serialize_state(StateArchive& archive) {
  wait();
  std::vector<PoseCorrection> corrections;
  for (Pending& pending : pending_) corrections.push_back(*pending.correction);
  archive(localizer_, corrections);
  pending_.clear();
  for (PoseCorrection& correction : corrections)
    pending_.push_back({.ticket = 0, .correction = std::make_unique<PoseCorrection>(std::move(correction))});
}

void KnownMapLocalizer::serialize_state(StateArchive& archive) {
  archive.section("localizer");
  archive(localizer_, confidence_);
}

void SlamLocalizer::serialize_state(StateArchive& archive) {
  archive.section("mapping");
  archive(mapper_, anchors_, is_mapping_);
}

void MapThenLocalize::serialize_state(StateArchive& archive) {
  bool is_on_map = !is_mapping();
  archive(is_on_map);
  if (is_on_map) {
    OccupancyGrid map;
    if (!archive.is_loading()) map = current_->map();
    archive(map);
    if (archive.is_loading()) current_ = make_on_map_(std::move(map));
  } else if (archive.is_loading() && !is_mapping()) {
    throw std::runtime_error("the stack has completed its map");
  }
  archive(current_, anchors_in_map_, path_of_mapping_, mapped_ranges_, range_biases_, p_map_body_);
}

}  // namespace patrol::stack
