#include "inspect/water/water_sounding.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::inspect {
namespace {

/// Returns element `index` of `count` uniform values from -max to max; 0 for a single value.
double uniform_step(int index, int count, double max) {
  return count == 1 ? 0.0 : max * (2.0 * index / (count - 1) - 1.0);
}

void check_joint_limit(const char* name, double angle_deg, const JointLimit& limit) {
  if (-angle_deg * kDegree >= limit.lower_rad && angle_deg * kDegree <= limit.upper_rad) return;
  throw InputError(fmt::format(
      "stack.inspection.water.sounding.{} = {}: outside the range of the mount: must be in [{:.1f}, {:.1f}] deg", name,
      angle_deg, limit.lower_rad / kDegree, limit.upper_rad / kDegree));
}

Eigen::Vector3d axis_of(const AntennaPose& pose) {
  return quaternion_from_rpy(0.0, pose.pitch_rad, pose.yaw_rad) * Eigen::Vector3d::UnitX();
}

double angle_between(const AntennaPose& a, const AntennaPose& b) {
  const Eigen::Vector3d first = axis_of(a), second = axis_of(b);
  return std::atan2(first.cross(second).norm(), first.dot(second));
}

AntennaPose pose_of(const AntennaState& state) { return {state.yaw_rad, state.pitch_rad}; }

}  // namespace

std::vector<AntennaPose> antenna_poses(const WaterSoundingSettings& settings, const AntennaGeometry& antenna) {
  validate(settings, "stack.inspection.water.sounding");
  check_joint_limit("max_yaw_deg", settings.max_yaw_deg, antenna.yaw);
  check_joint_limit("max_pitch_deg", settings.max_pitch_deg, antenna.pitch);
  std::vector<AntennaPose> poses;
  for (int row = 0; row < settings.pitches; ++row) {
    for (int step = 0; step < settings.yaws; ++step) {
      const int column = row % 2 == 0 ? step : settings.yaws - 1 - step;
      poses.push_back({.yaw_rad = kDegree * uniform_step(column, settings.yaws, settings.max_yaw_deg),
                       .pitch_rad = kDegree * uniform_step(row, settings.pitches, settings.max_pitch_deg)});
    }
  }
  return poses;
}

WaterSounding::WaterSounding(const WaterSoundingSettings& settings, const AntennaGeometry& antenna, Time start)
    : settings_(settings),
      stowed_{antenna.stowed_yaw_rad, antenna.stowed_pitch_rad},
      poses_(antenna_poses(settings, antenna)),
      since_(start) {}

void WaterSounding::on_antenna_state(const AntennaState& state) {
  if (state_ && state.stamp <= state_->stamp) return;
  constexpr double kStill_rad = 0.15 * kDegree;  // two steps of the encoder
  const bool is_there = angle_between(pose_of(state), commanded_) <= settings_.settled_tolerance_deg * kDegree;
  const bool is_still = state_ && angle_between(pose_of(state), pose_of(*state_)) <= kStill_rad;
  if (!is_there || !is_still) steady_since_.reset();
  else if (!steady_since_) steady_since_ = state_->stamp;
  state_ = state;
}

/// Returns whether the antenna is settled. Readings before the command are ignored.
bool WaterSounding::is_settled(Time now) const {
  return steady_since_ && state_->stamp > since_ &&
         now - std::max(*steady_since_, since_) >= from_seconds(settings_.settling_time_s);
}

InstrumentCommand WaterSounding::command_pose(const AntennaPose& pose, Phase phase, Time now) {
  commanded_ = pose;
  phase_ = phase;
  since_ = now;
  steady_since_.reset();
  return AntennaCommand{.stamp = now, .yaw_rad = pose.yaw_rad, .pitch_rad = pose.pitch_rad};
}

std::optional<InstrumentCommand> WaterSounding::next_command(Time now) {
  if (next_ == poses_.size()) return command_pose(stowed_, Phase::kStowing, now);
  return command_pose(poses_[next_++], Phase::kTurning, now);
}

std::optional<InstrumentCommand> WaterSounding::skip_pose(Time now) {
  ++num_skipped_;
  if (++num_skipped_in_a_row_ >= settings_.max_consecutive_failures) {
    num_skipped_ += static_cast<int>(poses_.size() - next_);
    next_ = poses_.size();
  }
  return next_command(now);
}

std::optional<InstrumentCommand> WaterSounding::step(Time now, const std::optional<AntennaState>& antenna,
                                                     const std::optional<TemSounding>& sounding) {
  if (antenna) on_antenna_state(*antenna);
  if (!has_begun_) {
    has_begun_ = true;
    return next_command(now);
  }
  const double waited_s = to_seconds(now - since_);
  switch (phase_) {
    case Phase::kTurning:
      if (!is_settled(now)) return waited_s > settings_.orientation_timeout_s ? skip_pose(now) : std::nullopt;
      phase_ = Phase::kSounding;
      since_ = now;
      return SoundingCommand{.stamp = now};
    case Phase::kSounding:
      if (!sounding || sounding->stamp <= since_)
        return waited_s > settings_.sounding_timeout_s ? skip_pose(now) : std::nullopt;
      soundings_.push_back({.pose = pose_of(*state_), .sounding = *sounding});
      sum_squared_error_rad2_ += std::pow(angle_between(commanded_, pose_of(*state_)), 2);
      num_skipped_in_a_row_ = 0;
      return next_command(now);
    case Phase::kStowing:
      is_stowed_ = is_settled(now);
      if (is_stowed_ || waited_s > settings_.orientation_timeout_s) phase_ = Phase::kOver;
      return std::nullopt;
    case Phase::kOver:
      return std::nullopt;
  }
  return std::nullopt;
}

double WaterSounding::antenna_error_deg() const {
  return soundings_.empty() ? 0.0
                            : std::sqrt(sum_squared_error_rad2_ / static_cast<double>(soundings_.size())) / kDegree;
}

}  // namespace patrol::inspect
