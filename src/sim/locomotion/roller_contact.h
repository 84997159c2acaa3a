#pragma once

#include <vector>

#include <mujoco/mujoco.h>

#include "core/robot_description.h"
#include "sim/locomotion/wheel_drive_settings.h"

namespace patrol::sim {

/// Makes the wheels of a robot mecanum wheels if `settings.type` is mecanum (core/wheel_kinematics.h). Throws
/// InputError that names the setting if the wheels of the robot do not suit.
void set_drive_type(const WheelDriveSettings& settings, RobotDescription& robot);

/// Contact of mecanum wheels with the ground.
///
/// The rollers have no bodies of their own: a wheel stays a rolling ellipsoid, and the friction of its contacts has two
/// coefficients (MuJoCo's elliptic cone). Along the axis of the roller that touches, it is that of the tire; across it,
/// where the roller rolls, it is `roller_friction`. The axis turns with the point of contact about the axle, so that
/// the contact with a curb ahead is right as well. MuJoCo chooses the tangential directions of a contact itself; this
/// class turns them, and the constraints are made again from the turned contacts.
///
/// Motions without slip along the axes and stops of locked wheels along x and y agree with closed forms. On a slope
/// along a diagonal, wheels that slide take up to a fifth of the load from those that roll.
///
/// Not modeled: the inertia of the rollers, the vibration and the lateral motion of the contact from one roller to the
/// next, and contact of the rim beside the rollers.
class RollerContact {
 public:
  /// No wheels without rollers. Throws InputError when the model lacks a wheel of the robot.
  RollerContact(const RobotDescription& robot, const WheelDriveSettings& settings, const mjModel& physics);

  bool is_empty() const { return wheels_.empty(); }

  /// Evaluates the physics at its state, as mj_forward does, with the friction of the rollers.
  void evaluate(const mjModel& physics, mjData& data) const;

 private:
  struct Wheel {
    int carrier;             ///< body of the chassis; its y axis is the axle, to the left
    double roller_axis_rad;  ///< direction of the roller axis on the ground, as in WheelGeometry
  };
  void set_friction(const mjData& data, mjContact& contact, const Wheel& wheel, bool is_first) const;

  std::vector<Wheel> wheels_;
  std::vector<int> wheel_of_geom_;  ///< index in wheels_; -1 for other geoms
  double roller_friction_ = 0.0;
};

}  // namespace patrol::sim
