#include "plan/control/differential_pose_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patrol::plan {
namespace {

constexpr double kApproachFacing_rad = 0.1;     // heading error within which driving begins
constexpr double kMaxHeadingError_rad = 0.6;    // heading error while driving that requires another turn in place
constexpr double kMinBearingDistance_m = 0.15;  // distance below which the bearing of the goal is too noisy
constexpr int kMaxChanges = 6;                  // phase changes within one step

/// Bearing of the goal position in body, from the bow; from the stern when driving backward.
double bearing_rad(const Pose2& T_goal_body, double forward) {
  const Eigen::Vector2d p_body = T_goal_body.inverse().position();
  return std::atan2(forward * p_body.y(), forward * p_body.x());
}

}  // namespace

void DifferentialPoseController::reset() {
  phase_ = Phase::kChoose;
  back_off_side_ = -1.0;
}

void DifferentialPoseController::block() {
  if (phase_ == Phase::kBackOff) back_off_side_ = -back_off_side_;
  phase_ = Phase::kChoose;
}

VelocityCommand DifferentialPoseController::step(const Pose2& T_map_body, const NavigationGoal& goal) {
  const Pose2 T_goal_body = goal.T_map_body.inverse() * T_map_body;
  // A completed phase enters another one, which begins in the same step.
  for (int changes = 0; changes < kMaxChanges; ++changes) {
    const Phase before = phase_;
    VelocityCommand command;
    switch (phase_) {
      case Phase::kChoose:
        phase_ = choose(T_goal_body, goal);
        forward_ = T_goal_body.x <= 0.0 ? 1.0 : -1.0;
        if (phase_ == Phase::kTurnToPosition) {
          const bool is_behind = std::abs(bearing_rad(T_goal_body, 1.0)) > std::numbers::pi / 2.0;
          forward_ = is_behind && T_goal_body.position().norm() <= settings_.max_reverse_distance_m ? -1.0 : 1.0;
        }
        break;
      case Phase::kTurnToPosition:
        command = turn_to_position(T_goal_body);
        break;
      case Phase::kDriveToPosition:
        command = drive_to_position(T_goal_body, goal);
        break;
      case Phase::kTurnToHeading:
        command = turn_to_heading(T_goal_body, goal);
        break;
      case Phase::kBackOff:
        command = back_off(T_goal_body, goal);
        break;
      case Phase::kDriveLine:
        command = drive_line(T_goal_body, goal);
        break;
      case Phase::kDone:
        break;
    }
    if (phase_ == before) return command;
  }
  return {};
}

DifferentialPoseController::Phase DifferentialPoseController::choose(const Pose2& T_goal_body,
                                                                     const NavigationGoal& goal) const {
  const double aim_m = settings_.tolerance_fraction * goal.position_tolerance_m;
  const double distance_m = T_goal_body.position().norm();
  if (goal.accepts_any_yaw()) return distance_m <= goal.position_tolerance_m ? Phase::kDone : Phase::kTurnToPosition;
  const double yaw_error = std::abs(T_goal_body.yaw);
  if (distance_m <= goal.position_tolerance_m) {
    return yaw_error <= goal.yaw_tolerance_rad ? Phase::kDone : Phase::kTurnToHeading;
  }
  const bool looks_along = yaw_error <= settings_.line.max_angle_rad;
  const double remaining_lateral_error_m =
      lateral_error_after_m(settings_.line, T_goal_body.y, std::abs(T_goal_body.x));
  if (looks_along && remaining_lateral_error_m <= aim_m) return Phase::kDriveLine;
  if (distance_m > settings_.lateral_correction_distance_m) return Phase::kTurnToPosition;
  return looks_along ? Phase::kBackOff : Phase::kTurnToHeading;
}

VelocityCommand DifferentialPoseController::turn_to_position(const Pose2& T_goal_body) {
  const double turn = bearing_rad(T_goal_body, forward_);
  if (std::abs(turn) > kApproachFacing_rad) return {.yaw_rate_radps = yaw_rate_radps(turn)};
  phase_ = Phase::kDriveToPosition;
  return {};
}

VelocityCommand DifferentialPoseController::drive_to_position(const Pose2& T_goal_body, const NavigationGoal& goal) {
  const double turn = bearing_rad(T_goal_body, forward_);
  const double distance_m = T_goal_body.position().norm();
  const double along_m = distance_m * std::cos(turn);
  if (along_m <= settings_.tolerance_fraction * goal.position_tolerance_m / 2.0) {
    phase_ = goal.accepts_any_yaw() ? Phase::kChoose : Phase::kTurnToHeading;
    return {};
  }
  const bool is_far = distance_m > kMinBearingDistance_m;
  if (is_far && std::abs(turn) > kMaxHeadingError_rad) {
    phase_ = Phase::kTurnToPosition;
    return {};
  }
  const double rate = settings_.line.yaw_gain_per_s * turn;
  const double limit = settings_.line.max_yaw_rate_radps;
  return {.vx_mps = forward_ * speed_mps(along_m), .yaw_rate_radps = is_far ? std::clamp(rate, -limit, limit) : 0.0};
}

VelocityCommand DifferentialPoseController::turn_to_heading(const Pose2& T_goal_body, const NavigationGoal& goal) {
  if (std::abs(T_goal_body.yaw) > settings_.tolerance_fraction * goal.yaw_tolerance_rad) {
    return {.yaw_rate_radps = yaw_rate_radps(-T_goal_body.yaw)};
  }
  phase_ = Phase::kChoose;
  return {};
}

VelocityCommand DifferentialPoseController::back_off(const Pose2& T_goal_body, const NavigationGoal& goal) {
  const double out_m = back_off_side_ * T_goal_body.x;  // distance from the goal toward that side
  const double remaining_lateral_error_m = lateral_error_after_m(settings_.line, T_goal_body.y, out_m);
  const bool is_enough =
      out_m > 0.0 && remaining_lateral_error_m <= settings_.tolerance_fraction * goal.position_tolerance_m / 2.0;
  if (is_enough || out_m >= settings_.max_back_off_m) {
    forward_ = -back_off_side_;
    phase_ = Phase::kDriveLine;
    return {};
  }
  return follow_line(settings_.line, T_goal_body, back_off_side_ * settings_.max_speed_mps);
}

VelocityCommand DifferentialPoseController::drive_line(const Pose2& T_goal_body, const NavigationGoal& goal) {
  const double remaining_m = -forward_ * T_goal_body.x;
  if (remaining_m > settings_.tolerance_fraction * goal.position_tolerance_m / 2.0) {
    return follow_line(settings_.line, T_goal_body, forward_ * speed_mps(remaining_m));
  }
  phase_ = Phase::kTurnToHeading;
  return {};
}

double DifferentialPoseController::speed_mps(double remaining_m) const {
  return std::clamp(settings_.speed_gain_per_s * remaining_m, settings_.min_speed_mps, settings_.max_speed_mps);
}

double DifferentialPoseController::yaw_rate_radps(double turn_rad) const {
  const double rate = settings_.line.yaw_gain_per_s * std::abs(turn_rad);
  return std::copysign(std::clamp(rate, settings_.min_yaw_rate_radps, settings_.line.max_yaw_rate_radps), turn_rad);
}

}  // namespace patrol::plan
