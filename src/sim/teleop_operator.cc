#include "sim/teleop_operator.h"

#include <algorithm>
#include <cmath>

namespace patrol::sim {
namespace {

constexpr double kLookAhead_m = 1.2;
constexpr double kAtGoal_m = 0.08;  // distance to a goal waypoint at which to stop
constexpr double kPassed_m = 0.6;   // distance to any other waypoint at which to continue with the next
constexpr double kAligned_rad = 0.03;
constexpr double kTurnFirst_rad = 0.9;  // direction error above which to turn in place
constexpr double kGoalPause_s = 1.5;    // standstill before and after the button press
constexpr double kMeeting_m = 1.5;      // distance within which the robot has arrived at the operator
constexpr double kStationary_m = 0.02;  // maximum motion of a robot that stands still
constexpr double kStationary_s = 4.0;   // required duration of the standstill

/// Returns the speed at a distance before a stop.
double speed_before_stop(double left_m) { return std::clamp(0.6 * left_m, 0.08, 10.0); }

}  // namespace

TeleopOperator::TeleopOperator(const TeleopOperatorSettings& settings, TeleopRoute drive, std::uint64_t seed)
    : settings_(settings), drive_(std::move(drive)), steering_noise_(seed, "remote/hand") {
  validate(settings, "teleop.operator");
  if (settings.wait_for_robot) phase_ = Phase::kWaiting;
}

std::optional<TeleopCommand> TeleopOperator::step(Time now, const Pose2& T_world_body,
                                                  const std::vector<Eigen::Vector2d>& p_world_people, bool is_busy) {
  if (phase_ == Phase::kDone || now < from_seconds(static_cast<double>(count_) / settings_.rate_hz))
    return std::nullopt;
  if (phase_ == Phase::kWaiting && !robot_has_arrived(now, T_world_body)) {
    ++count_;
    return std::nullopt;
  }
  observed_.emplace_back(now, T_world_body);
  while (observed_.size() > 1 && observed_[1].first <= now - from_seconds(settings_.reaction_time_s))
    observed_.pop_front();
  TeleopCommand command = decide(now, observed_.front().second, p_world_people, is_busy);
  command.stamp = now;
  ++count_;
  return command;
}

bool TeleopOperator::robot_has_arrived(Time now, const Pose2& T_world_body) {
  const bool is_here = (T_world_body.position() - drive_.front().p_m).norm() < kMeeting_m;
  if (!is_here || !stationary_since_ ||
      (T_world_body.position() - stationary_since_->second.position()).norm() > kStationary_m) {
    stationary_since_.reset();
    if (is_here) stationary_since_ = {now, T_world_body};
    return false;
  }
  if (now - stationary_since_->first < from_seconds(kStationary_s)) return false;
  phase_ = Phase::kDriving;
  return true;
}

TeleopCommand TeleopOperator::decide(Time now, const Pose2& T_world_body,
                                     const std::vector<Eigen::Vector2d>& p_world_people, bool is_busy) {
  if (!has_started_) has_started_ = true, leg_start_m_ = T_world_body.position();
  const auto enter = [&](Phase phase) { phase_ = phase, phase_start_ = now; };
  TeleopCommand command;
  switch (phase_) {
    case Phase::kDriving:
      if (is_pedestrian_ahead(T_world_body, p_world_people)) break;
      if (!has_passed_waypoint(T_world_body)) {
        drive(T_world_body, command);
      } else if (waypoint().is_goal) {
        enter(Phase::kTurning);
      } else if (next_ + 1 == drive_.size()) {
        enter(Phase::kLooking);
      } else {
        leg_start_m_ = drive_[next_++].p_m;
      }
      break;
    case Phase::kTurning:
      rotate_to(waypoint().heading_rad, T_world_body, command);
      if (std::abs(wrap_angle(waypoint().heading_rad - T_world_body.yaw)) < kAligned_rad)
        command = {}, enter(Phase::kLooking);
      break;
    case Phase::kLooking:
      if (now - phase_start_ < from_seconds(kGoalPause_s)) break;
      command.save_goal = waypoint().is_goal;
      enter(Phase::kSaved);
      break;
    case Phase::kSaved:
      if (is_busy) phase_start_ = now;
      if (now - phase_start_ < from_seconds(kGoalPause_s)) break;
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

void TeleopOperator::drive(const Pose2& T_world_body, TeleopCommand& command) {
  const double left_m = (waypoint().p_m - T_world_body.position()).norm();
  const bool stops = waypoint().is_goal || next_ + 1 == drive_.size();
  const double speed = stops ? std::min(settings_.speed_mps, speed_before_stop(left_m)) : settings_.speed_mps;
  const Eigen::Vector2d towards = T_world_body.inverse() * pursuit_point(T_world_body.position());
  const double sign = waypoint().is_reverse ? -1.0 : 1.0;
  const double bearing = std::atan2(sign * towards.y(), sign * towards.x());
  if (std::abs(bearing) > kTurnFirst_rad) {
    command.yaw_rate_radps = std::copysign(settings_.yaw_rate_radps, bearing);
    return;
  }
  const double curvature = 2.0 * std::sin(bearing) / std::max(towards.norm(), 0.3);
  command.vx_mps = sign * speed / (1.0 + std::abs(curvature));
  command.yaw_rate_radps =
      std::clamp(command.vx_mps * sign * curvature, -settings_.yaw_rate_radps, settings_.yaw_rate_radps) +
      settings_.steering_noise_std_radps * steering_noise_.normal(count_);
}

void TeleopOperator::rotate_to(double yaw_rad, const Pose2& T_world_body, TeleopCommand& command) const {
  const double left = wrap_angle(yaw_rad - T_world_body.yaw);
  command.yaw_rate_radps = std::copysign(std::clamp(1.2 * std::abs(left), 0.1, settings_.yaw_rate_radps), left);
}

bool TeleopOperator::has_passed_waypoint(const Pose2& T_world_body) const {
  const Eigen::Vector2d to_waypoint = waypoint().p_m - T_world_body.position();
  const bool stops = waypoint().is_goal || next_ + 1 == drive_.size();
  if (to_waypoint.norm() < (stops ? kAtGoal_m : kPassed_m)) return true;
  // Accept a waypoint that has been passed along the leg: do not turn back for a miss of a few centimeters.
  const Eigen::Vector2d leg = waypoint().p_m - leg_start_m_;
  return leg.norm() > 0.1 && to_waypoint.dot(leg) < 0.0 && to_waypoint.norm() < 2.0 * kPassed_m;
}

bool TeleopOperator::is_pedestrian_ahead(const Pose2& T_world_body,
                                         const std::vector<Eigen::Vector2d>& p_world_people) const {
  const double sign = waypoint().is_reverse ? -1.0 : 1.0;
  return std::any_of(p_world_people.begin(), p_world_people.end(), [&](const Eigen::Vector2d& p_world) {
    const Eigen::Vector2d p_body = T_world_body.inverse() * p_world;
    const double ahead_m = sign * p_body.x();
    return ahead_m > 0.0 && ahead_m < settings_.pedestrian_stop_distance_m + 0.5 && std::abs(p_body.y()) < 1.0;
  });
}

/// Returns the pursuit point on the leg, kLookAhead_m beyond the robot's projection; at the end of the leg the waypoint
/// itself.
Eigen::Vector2d TeleopOperator::pursuit_point(const Eigen::Vector2d& p_world_body) const {
  const Eigen::Vector2d leg = waypoint().p_m - leg_start_m_;
  if (leg.norm() < 0.1) return waypoint().p_m;
  const Eigen::Vector2d along = leg.normalized();
  const double at_m = (p_world_body - leg_start_m_).dot(along) + kLookAhead_m;
  return leg_start_m_ + std::clamp(at_m, 0.0, leg.norm()) * along;
}

}  // namespace patrol::sim
