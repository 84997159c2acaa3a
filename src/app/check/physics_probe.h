#pragma once

#include <set>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/robot_description.h"

namespace patrol::app {

/// Measures motors, travels and contacts of a robot in the physics model.
class PhysicsProbe {
 public:
  /// Throws InputError when the model lacks a joint of the robot.
  PhysicsProbe(const RobotDescription& robot, const mjModel& physics);

  struct MotorLoad {
    double max_torque_ratio = 0.0;
    double mean_torque_ratio = 0.0;
    double max_speed_ratio = 0.0;
  };
  /// Returns the load of the motors of legs, wheels and sprockets relative to the limits of their joints. Steering
  /// servos are left out: they use their full speed at every change of the curvature.
  MotorLoad motor_load(const mjData& data) const;

  /// Returns the mean travel of the driven wheels or of the track of a side, by the angles of the joints and the
  /// nominal radii, m; 0 for legs.
  double travel_m(const mjData& data, bool is_left) const;

  struct GroundContact {
    bool is_of_hull = false;  ///< a part that is neither wheel, track nor foot is in contact
    double friction = 0.0;    ///< largest friction coefficient of wheels, tracks and feet in contact
  };
  GroundContact ground_contact(const mjData& data) const;

 private:
  struct Motor {
    int actuator, dof;
    double max_torque_nm, max_speed_radps;
  };
  struct Roller {
    int qpos;
    bool is_left;
    double m_per_rad;  ///< signed: positive forward
  };

  const mjModel& physics_;
  int robot_root_;
  std::vector<Motor> motors_;
  std::vector<Roller> rollers_;
  std::set<int> footing_;  ///< geoms of wheels, tracks and feet
};

}  // namespace patrol::app
