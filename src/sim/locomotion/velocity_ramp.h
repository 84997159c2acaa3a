#pragma once

#include <algorithm>
#include <cmath>

#include "core/messages.h"

namespace patrol::sim {

/// Returns `value` moved toward `target` by at most `max_change`.
inline double moved_toward(double value, double target, double max_change) {
  return value + std::clamp(target - value, -max_change, max_change);
}

/// Velocity command of a drive, limited in speed and acceleration.
class VelocityRamp {
 public:
  struct Limits {
    double speed_mps;
    double yaw_rate_radps;
    double acceleration_mps2;
    double yaw_acceleration_radps2;
    double lateral_mps = 0.0;  ///< 0: the drive ignores lateral commands
  };
  VelocityRamp(const Limits& limits, double tick_s) : limits_(limits), tick_s_(tick_s) {}

  /// Follows the command for one tick.
  void step(const VelocityCommand& command) {
    const double speed = std::clamp(command.vx_mps, -limits_.speed_mps, limits_.speed_mps);
    const double rate = std::clamp(command.yaw_rate_radps, -limits_.yaw_rate_radps, limits_.yaw_rate_radps);
    speed_mps_ = moved_toward(speed_mps_, speed, limits_.acceleration_mps2 * tick_s_);
    const double lateral = std::clamp(command.vy_mps, -limits_.lateral_mps, limits_.lateral_mps);
    lateral_mps_ = moved_toward(lateral_mps_, lateral, limits_.acceleration_mps2 * tick_s_);
    yaw_rate_radps_ = moved_toward(yaw_rate_radps_, rate, limits_.yaw_acceleration_radps2 * tick_s_);
  }

  double speed_mps() const { return speed_mps_; }
  double lateral_mps() const { return lateral_mps_; }  ///< positive to the left
  double yaw_rate_radps() const { return yaw_rate_radps_; }
  /// Returns whether the robot is commanded to stand.
  bool is_at_rest() const {
    return std::abs(speed_mps_) < 0.005 && std::abs(lateral_mps_) < 0.005 && std::abs(yaw_rate_radps_) < 0.005;
  }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(speed_mps_, lateral_mps_, yaw_rate_radps_);
  }

 private:
  Limits limits_;
  double tick_s_;
  double speed_mps_ = 0.0, lateral_mps_ = 0.0, yaw_rate_radps_ = 0.0;
};

}  // namespace patrol::sim
