#pragma once

#include "core/settings.h"

namespace patrol::sim {

/// Settings of the tracks, their motors and their firmware.
struct TrackDriveSettings {
  double friction = 0.8;                     ///< friction coefficient of the rubber on ground that does not define
                                             ///< its own
  double max_speed_mps = 1.0;                ///< speed limit of each track and of the robot
  double max_yaw_rate_radps = 0.8;           ///< maximum yaw rate
  double max_acceleration_mps2 = 0.8;        ///< maximum acceleration of the commanded velocity
  double max_yaw_acceleration_radps2 = 1.5;  ///< maximum acceleration of the commanded yaw rate
  double effective_gauge_factor = 1.41;      ///< gauge in the firmware's kinematics relative to the geometric one;
                                             ///< above 1 because of track slip in turns
  bool use_gyro = true;                      ///< use of the gyroscope to correct the yaw rate
  double gyro_gain = 0.3;                    ///< yaw rate correction per rad/s of yaw rate error
  double gyro_integral_per_s = 2.0;          ///< yaw rate correction per rad of heading error
  double max_gyro_correction_radps = 0.4;    ///< maximum correction of the yaw rate by the gyro
  double kp_nms = 8.0;                       ///< torque per rad/s of speed error
  double ki_nm = 40.0;                       ///< torque per rad of lag angle
  double kd_nms2 = 0.02;                     ///< torque per rad/s2 of acceleration error
  double observer_bandwidth_radps = 100.0;   ///< bandwidth of the speed observer on the Hall counts
  double stall_torque_nm = 120.0;            ///< stall torque of the motor at the sprocket, without its current
                                             ///< limit
  double brake_torque_nm = 60.0;             ///< torque of the parking brake on each sprocket
  double brake_delay_s = 0.5;                ///< time at rest without command before the brake closes

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("friction", self.friction, between(0.0, 2.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.05, 2.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.05, 3.0));
    visit("max_acceleration_mps2", self.max_acceleration_mps2, between(0.05, 5.0));
    visit("max_yaw_acceleration_radps2", self.max_yaw_acceleration_radps2, between(0.05, 10.0));
    visit("effective_gauge_factor", self.effective_gauge_factor, between(1.0, 4.0));
    visit("use_gyro", self.use_gyro);
    visit("gyro_gain", self.gyro_gain, between(0.0, 2.0));
    visit("gyro_integral_per_s", self.gyro_integral_per_s, between(0.0, 10.0));
    visit("max_gyro_correction_radps", self.max_gyro_correction_radps, between(0.0, 2.0));
    visit("kp_nms", self.kp_nms, between(0.0, 30.0));
    visit("ki_nm", self.ki_nm, between(0.0, 300.0));
    visit("kd_nms2", self.kd_nms2, between(0.0, 1.0));
    visit("observer_bandwidth_radps", self.observer_bandwidth_radps, between(5.0, 200.0));
    visit("stall_torque_nm", self.stall_torque_nm, at_least(1.0));
    visit("brake_torque_nm", self.brake_torque_nm, at_least(0.0));
    visit("brake_delay_s", self.brake_delay_s, between(0.0, 10.0));
  }
};

}  // namespace patrol::sim
