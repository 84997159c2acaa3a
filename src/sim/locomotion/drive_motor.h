#pragma once

#include <algorithm>
#include <cmath>

namespace patrol::sim {

/// Geared brushless motor of a sprocket or wheel. The current limits the torque; with rising speed the battery voltage
/// reduces it along the straight speed-torque line of a direct-current motor.
struct DriveMotor {
  double max_torque_nm = 0.0;    ///< torque at the current limit
  double stall_torque_nm = 0.0;  ///< torque of the line at zero speed, without current limit
  double no_load_radps = 0.0;    ///< speed of the line at zero torque

  /// Returns the feasible torque nearest to the requested one. Against its motion the motor brakes with up to the full
  /// current.
  double feasible_torque_nm(double requested_nm, double speed_radps) const {
    const bool is_driving = requested_nm * speed_radps > 0.0;
    const double line_nm = stall_torque_nm * (1.0 - std::abs(speed_radps) / no_load_radps);
    const double limit_nm = is_driving ? std::clamp(line_nm, 0.0, max_torque_nm) : max_torque_nm;
    return std::clamp(requested_nm, -limit_nm, limit_nm);
  }
};

}  // namespace patrol::sim
