#include "plan/control/docking.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patrol::plan {
namespace {

constexpr double kDockFacing_rad = 0.05;  // heading error to the line within which driving begins

}  // namespace

Docking::Docking(const DockingSettings& settings) : settings_(settings), pose_filter_(settings.pose_filter) {
  validate(settings_, "docking");
}

NavigationGoal Docking::staging_goal(const Pose2& T_map_docked) const {
  return {.T_map_body = T_map_docked * Pose2{-settings_.staging_distance_m, 0.0, 0.0},
          .position_tolerance_m = settings_.staging_tolerance_m,
          .yaw_tolerance_rad = settings_.staging_tolerance_rad};
}

void Docking::dock(Time now) {
  pose_filter_.reset();
  start_ = now;
  num_attempts_ = 1;
  enter(Phase::kDetect, "Searching for the charging post.");
}

void Docking::undock(Time now, const Pose2& T_odom_body) {
  start_ = now;
  T_odom_left_ = T_odom_body;
  enter(Phase::kUndock, "Leaving the charging post.");
}

void Docking::stop() { enter(Phase::kIdle, ""); }

void Docking::add(const DockDetection& detection, const Pose2& T_odom_body) {
  if (status() == DockingStatus::kDocking && detection.stamp >= start_) pose_filter_.add(detection, T_odom_body);
}

std::optional<Pose2> Docking::T_level_docked(const Pose2& T_odom_body) const {
  if (!pose_filter_.T_odom_docked()) return std::nullopt;
  return T_odom_body.inverse() * *pose_filter_.T_odom_docked();
}

DockingStatus Docking::status() const {
  switch (phase_) {
    case Phase::kIdle:
      return DockingStatus::kIdle;
    case Phase::kDocked:
      return DockingStatus::kDocked;
    case Phase::kUndock:
      return DockingStatus::kUndocking;
    case Phase::kFree:
      return DockingStatus::kFree;
    case Phase::kFailed:
      return DockingStatus::kFailed;
    default:
      return DockingStatus::kDocking;
  }
}

DockingStep Docking::step(Time now, const Pose2& T_odom_body) {
  VelocityCommand command;
  if (phase_ == Phase::kUndock) command = drive_out(T_odom_body);
  if (status() == DockingStatus::kDocking || status() == DockingStatus::kUndocking) {
    if (now - start_ > from_seconds(settings_.timeout_s)) {
      const bool is_leaving = status() == DockingStatus::kUndocking;
      enter(Phase::kFailed, is_leaving ? "Undocking failed: timeout." : "Docking failed: timeout.");
    }
  }
  if (status() == DockingStatus::kDocking) {
    const double detection_age_s = to_seconds(now - std::max(start_, pose_filter_.last_stamp()));
    if (detection_age_s > settings_.detection_timeout_s) {
      enter(Phase::kFailed, "Docking failed: charging post not detected.");
    } else if (pose_filter_.num_detections() >= settings_.min_detections &&
               detection_age_s <= settings_.max_detection_gap_s) {
      const Pose2 T_docked_body = pose_filter_.T_odom_docked()->inverse() * T_odom_body;
      if (phase_ == Phase::kDetect) enter(Phase::kTurn, "Charging post detected.");
      if (phase_ == Phase::kTurn) command = turn_to_line(T_docked_body);
      if (phase_ == Phase::kDriveIn) command = drive_in(now, T_docked_body);
      if (phase_ == Phase::kCheck) check_docked(now, T_docked_body);
      if (phase_ == Phase::kCorrect) command = correct(now, T_docked_body);
      if (phase_ == Phase::kBackUp) command = back_up(T_docked_body);
    }
  }
  if (status() == DockingStatus::kFailed || status() == DockingStatus::kDocked) command = {};
  return {.command = command, .status = status(), .text = std::exchange(text_, {})};
}

VelocityCommand Docking::turn_to_line(const Pose2& T_docked_body) {
  const double turn = wrap_angle(line_heading_rad(settings_.line, T_docked_body.y, 1.0) - T_docked_body.yaw);
  if (std::abs(turn) > kDockFacing_rad) return {.yaw_rate_radps = yaw_rate_radps(turn)};
  enter(Phase::kDriveIn, "");
  return {};
}

VelocityCommand Docking::drive_in(Time now, const Pose2& T_docked_body) {
  const double remaining_m = -T_docked_body.x;
  if (std::abs(T_docked_body.y) >
      settings_.corridor_half_width_m + settings_.corridor_slope * std::max(0.0, remaining_m)) {
    retry();
    return {};
  }
  if (remaining_m <= settings_.position_tolerance_m / 3.0) {
    stationary_since_ = now;
    enter(Phase::kCheck, "");
    return {};
  }
  LineFollowingSettings line = settings_.line;
  if (remaining_m < settings_.heading_blend_distance_m)
    line.lateral_gain_per_m *= remaining_m / settings_.heading_blend_distance_m;
  const double speed =
      std::clamp(settings_.speed_gain_per_s * remaining_m, settings_.min_speed_mps, settings_.max_speed_mps);
  return follow_line(line, T_docked_body, speed);
}

/// Waits for `settling_time_s`, then reports the docked pose, corrects a small error, or retries.
void Docking::check_docked(Time now, const Pose2& T_docked_body) {
  if (now - stationary_since_ < from_seconds(settings_.settling_time_s)) return;
  if (std::abs(T_docked_body.y) > settings_.position_tolerance_m) return retry();
  const bool is_there = std::abs(T_docked_body.x) <= settings_.position_tolerance_m;
  const bool is_square = std::abs(T_docked_body.yaw) <= settings_.yaw_tolerance_rad;
  if (is_there && is_square) return enter(Phase::kDocked, "Docked at the charging post.");
  enter(Phase::kCorrect, "");
}

/// Aims at half of the tolerances, so that the motion ends well within them, and returns to kCheck.
VelocityCommand Docking::correct(Time now, const Pose2& T_docked_body) {
  if (std::abs(T_docked_body.yaw) > settings_.yaw_tolerance_rad / 2.0) {
    return {.yaw_rate_radps = yaw_rate_radps(-T_docked_body.yaw)};
  }
  if (std::abs(T_docked_body.x) > settings_.position_tolerance_m / 2.0) {
    return {.vx_mps = std::copysign(settings_.min_speed_mps, -T_docked_body.x)};
  }
  stationary_since_ = now;
  enter(Phase::kCheck, "");
  return {};
}

VelocityCommand Docking::back_up(const Pose2& T_docked_body) {
  if (-T_docked_body.x < settings_.staging_distance_m)
    return follow_line(settings_.line, T_docked_body, -settings_.max_speed_mps);
  enter(Phase::kTurn, "");
  return {};
}

VelocityCommand Docking::drive_out(const Pose2& T_odom_body) {
  const Pose2 T_left_body = T_odom_left_.inverse() * T_odom_body;
  if (-T_left_body.x < settings_.undock_distance_m)
    return follow_line(settings_.line, T_left_body, -settings_.max_speed_mps);
  enter(Phase::kFree, "Left the charging post.");
  return {};
}

void Docking::retry() {
  if (++num_attempts_ > settings_.max_attempts)
    return enter(Phase::kFailed, "Docking failed: no alignment with the charging post.");
  enter(Phase::kBackUp, "Docking: outside the approach corridor, backing up to retry.");
}

void Docking::enter(Phase phase, const char* text) {
  phase_ = phase;
  if (*text != 0) text_ = text;
}

double Docking::yaw_rate_radps(double turn_rad) const {
  const double rate = settings_.line.yaw_gain_per_s * std::abs(turn_rad);
  return std::copysign(std::clamp(rate, settings_.min_yaw_rate_radps, settings_.line.max_yaw_rate_radps), turn_rad);
}

}  // namespace patrol::plan
