#pragma once

#include <algorithm>
#include <cmath>

namespace patrol::sim {

/// A geared brushless motor as its drive sees it, at the sprocket: the current limits the torque, and the battery's voltage lets
/// less and less of it through as the motor turns faster (the straight speed-torque line of a direct-current motor).
struct TrackMotor {
  double max_torque_nm = 0.0;     ///< at the current limit
  double stall_torque_nm = 0.0;   ///< where the line meets zero speed, were there no current limit
  double no_load_radps = 0.0;     ///< where it meets zero torque

  /// The torque nearest to the wanted one that the motor can give. Against its motion it brakes with all the current it may.
  double possible_nm(double wanted_nm, double speed_radps) const {
    const bool is_driving = wanted_nm * speed_radps > 0.0;
    const double line_nm = stall_torque_nm * (1.0 - std::abs(speed_radps) / no_load_radps);
    const double limit_nm = is_driving ? std::clamp(line_nm, 0.0, max_torque_nm) : max_torque_nm;
    return std::clamp(wanted_nm, -limit_nm, limit_nm);
  }
};

}  // namespace patrol::sim
