#include "sim/remote_operator.h"

#include <algorithm>
#include <cmath>

namespace patrol::sim {
namespace {

constexpr double kLookAhead_m = 1.2;
constexpr double kAtMark_m = 0.08;     // distance to a marked waypoint at which to stop
constexpr double kPassed_m = 0.6;      // distance to any other waypoint at which to continue with the next
constexpr double kAligned_rad = 0.03;
constexpr double kTurnFirst_rad = 0.9; // direction error above which to turn in place
constexpr double kLook_s = 1.5;        // standstill before and after the button press
constexpr double kMeeting_m = 1.5;     // distance within which the robot has arrived at the operator
constexpr double kStands_m = 0.02;     // maximum motion of a robot that stands still
constexpr double kStands_s = 4.0;      // required duration of the standstill

/// Returns the speed at a distance before a stop.
double speed_before_stop(double left_m) { return std::clamp(0.6 * left_m, 0.08, 10.0); }

}  // namespace

RemoteOperator::RemoteOperator(const RemoteOperatorSettings& settings, RemoteDrive drive, std::uint64_t seed)
    : settings_(settings), drive_(std::move(drive)), hand_(seed, "remote/hand") {
  validate(settings, "remote.operator");
  if (settings.meets_robot) phase_ = Phase::kWaiting;
}

std::optional<RemoteCommand> RemoteOperator::step(Time now, const Pose2& T_world_body,
                                                  const std::vector<Eigen::Vector2d>& p_world_people, bool is_busy) {
  if (phase_ == Phase::kDone || now < from_seconds(static_cast<double>(count_) / settings_.rate_hz)) return std::nullopt;
  if (phase_ == Phase::kWaiting && !has_met(now, T_world_body)) {
    ++count_;
    return std::nullopt;
  }
  seen_.emplace_back(now, T_world_body);
  while (seen_.size() > 1 && seen_[1].first <= now - from_seconds(settings_.reaction_s)) seen_.pop_front();
  RemoteCommand command = decide(now, seen_.front().second, p_world_people, is_busy);
  command.stamp = now;
  ++count_;
  return command;
}

bool RemoteOperator::has_met(Time now, const Pose2& T_world_body) {
  const bool is_here = (T_world_body.position() - drive_.front().p_m).norm() < kMeeting_m;
  if (!is_here || !stands_since_ || (T_world_body.position() - stands_since_->second.position()).norm() > kStands_m) {
    stands_since_.reset();
    if (is_here) stands_since_ = {now, T_world_body};
    return false;
  }
  if (now - stands_since_->first < from_seconds(kStands_s)) return false;
  phase_ = Phase::kDriving;
  return true;
}

RemoteCommand RemoteOperator::decide(Time now, const Pose2& T_world_body,
                                     const std::vector<Eigen::Vector2d>& p_world_people, bool is_busy) {
  if (!has_started_) has_started_ = true, leg_start_m_ = T_world_body.position();
  const auto enter = [&](Phase phase) { phase_ = phase, phase_start_ = now; };
  RemoteCommand command;
  switch (phase_) {
    case Phase::kDriving:
      if (is_somebody_ahead(T_world_body, p_world_people)) break;
      if (!passed(T_world_body)) {
        drive(T_world_body, command);
      } else if (waypoint().is_mark) {
        enter(Phase::kTurning);
      } else if (next_ + 1 == drive_.size()) {
        enter(Phase::kLooking);
      } else {
        leg_start_m_ = drive_[next_++].p_m;
      }
      break;
    case Phase::kTurning:
      turn_to(waypoint().heading_rad, T_world_body, command);
      if (std::abs(wrap_angle(waypoint().heading_rad - T_world_body.yaw)) < kAligned_rad) command = {}, enter(Phase::kLooking);
      break;
    case Phase::kLooking:
      if (now - phase_start_ < from_seconds(kLook_s)) break;
      command.mark = waypoint().is_mark;
      enter(Phase::kMarked);
      break;
    case Phase::kMarked:
      if (is_busy) phase_start_ = now;
      if (now - phase_start_ < from_seconds(kLook_s)) break;
      if (next_ + 1 < drive_.size()) {
        leg_start_m_ = drive_[next_++].p_m;
        enter(Phase::kDriving);
      } else {
        command.hand_over = true;
        enter(Phase::kDone);
      }
      break;
    case Phase::kWaiting:
    case Phase::kDone:
      break;
  }
  return command;
}

void RemoteOperator::drive(const Pose2& T_world_body, RemoteCommand& command) {
  const double left_m = (waypoint().p_m - T_world_body.position()).norm();
  const bool stops = waypoint().is_mark || next_ + 1 == drive_.size();
  const double speed = stops ? std::min(settings_.speed_mps, speed_before_stop(left_m)) : settings_.speed_mps;
  const Eigen::Vector2d towards = T_world_body.inverse() * pursued_point(T_world_body.position());
  const double sign = waypoint().is_reverse ? -1.0 : 1.0;
  const double bearing = std::atan2(sign * towards.y(), sign * towards.x());
  if (std::abs(bearing) > kTurnFirst_rad) {
    command.yaw_rate_radps = std::copysign(settings_.yaw_rate_radps, bearing);
    return;
  }
  const double curvature = 2.0 * std::sin(bearing) / std::max(towards.norm(), 0.3);
  command.vx_mps = sign * speed / (1.0 + std::abs(curvature));
  command.yaw_rate_radps = std::clamp(command.vx_mps * sign * curvature, -settings_.yaw_rate_radps, settings_.yaw_rate_radps) +
                           settings_.steering_noise_radps * hand_.normal(count_);
}

void RemoteOperator::turn_to(double yaw_rad, const Pose2& T_world_body, RemoteCommand& command) const {
  const double left = wrap_angle(yaw_rad - T_world_body.yaw);
  command.yaw_rate_radps = std::copysign(std::clamp(1.2 * std::abs(left), 0.1, settings_.yaw_rate_radps), left);
}

bool RemoteOperator::passed(const Pose2& T_world_body) const {
  const Eigen::Vector2d to_waypoint = waypoint().p_m - T_world_body.position();
  const bool stops = waypoint().is_mark || next_ + 1 == drive_.size();
  if (to_waypoint.norm() < (stops ? kAtMark_m : kPassed_m)) return true;
  // Accept a waypoint that has been passed along the leg: do not turn back for a miss of a few centimeters.
  const Eigen::Vector2d leg = waypoint().p_m - leg_start_m_;
  return leg.norm() > 0.1 && to_waypoint.dot(leg) < 0.0 && to_waypoint.norm() < 2.0 * kPassed_m;
}

bool RemoteOperator::is_somebody_ahead(const Pose2& T_world_body, const std::vector<Eigen::Vector2d>& p_world_people) const {
  const double sign = waypoint().is_reverse ? -1.0 : 1.0;
  return std::any_of(p_world_people.begin(), p_world_people.end(), [&](const Eigen::Vector2d& p_world) {
    const Eigen::Vector2d p_body = T_world_body.inverse() * p_world;
    const double ahead_m = sign * p_body.x();
    return ahead_m > 0.0 && ahead_m < settings_.stop_for_people_m + 0.5 && std::abs(p_body.y()) < 1.0;
  });
}

/// Returns the pursuit point on the leg, kLookAhead_m beyond the robot's projection; at the end of the leg the waypoint
/// itself.
Eigen::Vector2d RemoteOperator::pursued_point(const Eigen::Vector2d& p_world_body) const {
  const Eigen::Vector2d leg = waypoint().p_m - leg_start_m_;
  if (leg.norm() < 0.1) return waypoint().p_m;
  const Eigen::Vector2d along = leg.normalized();
  const double at_m = (p_world_body - leg_start_m_).dot(along) + kLookAhead_m;
  return leg_start_m_ + std::clamp(at_m, 0.0, leg.norm()) * along;
}

}  // namespace patrol::sim
