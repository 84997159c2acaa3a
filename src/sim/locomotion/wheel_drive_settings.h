#pragma once

#include <numbers>
#include <string>

#include "core/settings.h"

namespace patrol::sim {

/// Settings of the wheels, their motors and their firmware. Torques and speeds of the motors are the limits of the
/// joints in the URDF.
struct WheelDriveSettings {
  /// Type of the drive: auto (differential or Ackermann, by the joints of the URDF) or mecanum (four driven wheels with
  /// rollers).
  std::string type = "auto";
  /// Pattern of the axes of the upper rollers of mecanum wheels, seen from above: x if they point toward the middle of
  /// the robot, o for the other direction.
  std::string roller_pattern = "x";
  double roller_angle_rad = 0.25 * std::numbers::pi;  ///< angle between the axes of the rollers and the axle
  /// Friction coefficient of mecanum wheels across the axes of their rollers: bearings and rolling resistance of the
  /// rollers.
  double roller_friction = 0.02;
  double friction = 0.8;                ///< friction coefficient of the tires on ground that does not define its own
  double rolling_resistance = 0.015;    ///< rolling resistance of each wheel relative to its load
  double tire_deflection_ratio = 0.02;  ///< deflection of each tire under the weight on its wheel relative to its
                                        ///< radius
  double tire_damping_ratio = 0.15;     ///< damping ratio of the robot on its tires
  double rotor_inertia_ratio = 0.2;     ///< inertia of each motor behind its gear relative to the mass on its wheel
                                        ///< times the squared wheel radius
  double max_speed_mps = 1.0;           ///< maximum speed of the robot
  double max_lateral_speed_mps = 0.5;   ///< maximum lateral speed of a mecanum drive
  double max_yaw_rate_radps = 1.0;      ///< maximum yaw rate
  double max_acceleration_mps2 = 1.0;   ///< maximum acceleration of the commanded velocity
  double max_yaw_acceleration_radps2 = 2.0;  ///< maximum acceleration of the commanded yaw rate
  double effective_gauge_factor = 0.0;       ///< gauge in the firmware's kinematics relative to the geometric one; 0 is
                                             ///< the closed form of Coulomb friction for the wheels of the robot
  double speed_bandwidth_radps = 20.0;       ///< bandwidth of the speed controllers of the wheels
  double observer_bandwidth_radps = 200.0;   ///< bandwidth of the speed observers on the encoder counts
  double stall_torque_ratio = 2.5;           ///< stall torque of each motor without its current limit, relative to the
                                             ///< maximum torque
  double brake_torque_ratio = 1.0;           ///< torque of each parking brake relative to the motor's maximum torque
  double brake_delay_s = 0.5;                ///< time at rest without command before the brakes close

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("type", self.type, one_of({"auto", "mecanum"}));
    visit("roller_pattern", self.roller_pattern, one_of({"x", "o"}));
    visit("roller_angle_rad", self.roller_angle_rad, between(0.35, 1.22));
    visit("roller_friction", self.roller_friction, between(0.001, 0.5));
    visit("friction", self.friction, between(0.0, 2.0));
    visit("rolling_resistance", self.rolling_resistance, between(0.0, 0.5));
    visit("tire_deflection_ratio", self.tire_deflection_ratio, between(0.002, 0.2));
    visit("tire_damping_ratio", self.tire_damping_ratio, between(0.01, 2.0));
    visit("rotor_inertia_ratio", self.rotor_inertia_ratio, between(0.01, 10.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.05, 10.0));
    visit("max_lateral_speed_mps", self.max_lateral_speed_mps, between(0.05, 10.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.05, 10.0));
    visit("max_acceleration_mps2", self.max_acceleration_mps2, between(0.05, 10.0));
    visit("max_yaw_acceleration_radps2", self.max_yaw_acceleration_radps2, between(0.05, 20.0));
    visit("effective_gauge_factor", self.effective_gauge_factor, between(0.0, 4.0));
    visit("speed_bandwidth_radps", self.speed_bandwidth_radps, between(1.0, 50.0));
    visit("observer_bandwidth_radps", self.observer_bandwidth_radps, between(5.0, 200.0));
    visit("stall_torque_ratio", self.stall_torque_ratio, between(1.0, 20.0));
    visit("brake_torque_ratio", self.brake_torque_ratio, between(0.0, 10.0));
    visit("brake_delay_s", self.brake_delay_s, between(0.0, 10.0));
  }
};

}  // namespace patrol::sim
