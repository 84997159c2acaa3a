#pragma once

#include <optional>

namespace patrol::app {

/// Velocity command of a part of a maneuver. The command rises to its value, and falls to zero at the end, both at
/// `ramp_s`.
struct DriveSegment {
  double vx_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double duration_s = 0.0;  ///< integral of the command over its value: distance over speed, or angle over yaw rate
  double ramp_s = 0.0;      ///< duration of the rise and of the fall
  /// The segment ends when the robot is at this distance ahead of its start, m, and at the latest after `duration_s`.
  std::optional<double> goal_ahead_m = std::nullopt;
  double vy_mps = 0.0;               ///< lateral velocity, positive to the left
  bool is_stopped_abruptly = false;  ///< the command falls to zero at once
  double rest_s = 0.0;               ///< time without command after the fall
};

}  // namespace patrol::app
