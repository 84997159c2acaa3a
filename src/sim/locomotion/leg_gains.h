#pragma once

#include <Eigen/Core>

#include "core/robot_description.h"

namespace patrol::sim {

/// Gains of the walking firmware. The defaults are tuned for a robot of 13.56 kg with legs of 0.426 m
/// (models/quadruped). `scaled_leg_gains` returns those of another robot.
///
/// Virtual model of the trunk: stiffness and damping per kg of robot mass for translations, per kg m2 of `inertia` for
/// rotations.
struct LegGains {
  double height_stiffness = 120.0;       ///< 1/s2
  double height_damping = 14.0;          ///< 1/s
  double velocity_gain = 5.0;            ///< 1/s
  double velocity_integral = 3.0;        ///< 1/s2
  double max_velocity_integral_m = 0.3;  ///< limit of the integral of the velocity error
  double standing_stiffness = 60.0;      ///< 1/s2, about the center of the feet
  double standing_damping = 10.0;        ///< 1/s
  double max_standing_offset_m = 0.02;   ///< offset of the place at which the robot came to a stand
  double tilt_stiffness = 400.0;         ///< 1/s2
  double tilt_damping = 40.0;            ///< 1/s
  double yaw_stiffness = 80.0;           ///< 1/s2
  double yaw_damping = 14.0;             ///< 1/s
  Eigen::Vector3d inertia_per_kg_m2 = {0.008, 0.024, 0.028};  ///< about roll, pitch and yaw, per kg of robot mass

  /// Center of mass in body, relative to its place in the tuned robot. The virtual model acts on this point. The feet
  /// stand, and touch down, about this point: off the line between two stance feet, gravity rolls the trunk over them.
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();

  // Impedance of a swing foot about its trajectory.
  double swing_stiffness_npm = 700.0;
  double swing_damping_nspm = 16.0;
  double capture_time_s = 0.06;    ///< lead of the foot placement per m/s of velocity error [Raibert86]
  double max_step_m = 0.2;         ///< maximum distance of a touch-down from the point below the hip
  double search_speed_mps = 0.35;  ///< speed downward of a foot that misses the ground
  double max_search_m = 0.10;

  // Impedance of the feet about the standing posture, until the estimator has settled.
  double wake_up_stiffness_npm = 3000.0;
  double wake_up_damping_nspm = 60.0;

  double ground_time_s = 0.15;       ///< time constant of the ground estimate below the feet
  double velocity_time_s = 0.02;     ///< time constant of the stance feet in the estimated velocity
  double max_stop_speed_mps = 0.12;  ///< speed of the trunk below which the robot changes from walking to standing
  double collapsed_m = 0.12;         ///< height of the trunk above the feet below which the robot has fallen
  double touch_force_n = 12.0;       ///< foot force above which a foot touches the ground
  double min_foot_force_n = 5.0;     ///< minimum normal force of a stance foot
  double max_foot_force_n = 220.0;
};

/// Returns the gains for a robot with legs: lengths are proportional to the length of the legs, times to its square
/// root (equal Froude numbers [Alexander83]), forces to the mass, and moments to the inertia of the standing robot. The
/// damping of a swing foot is proportional to the inertia of the leg at its foot, of which the rotors of the motors
/// have the larger part: the errors of its trajectory decay within the same fraction of the swing. Its stiffness is
/// proportional to the force, at most to that inertia. Ratios of mass and inertia are rounded to 1 %.
LegGains scaled_leg_gains(const RobotDescription& robot);

}  // namespace patrol::sim
