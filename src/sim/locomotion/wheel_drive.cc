#include "sim/locomotion/wheel_drive.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "sim/locomotion/tire_contact.h"
#include "sim/mujoco.h"

namespace patrol::sim {
namespace {

int find(const mjModel& physics, mjtObj type, const std::string& name, const RobotDescription& robot) {
  const int id = mj_name2id(&physics, type, name.c_str());
  if (id < 0) throw InputError("robot " + robot.name + ": the physics model lacks " + name);
  return id;
}

/// Gives joints of wheels without motors, and of casters, an inertia of 1 % of the mass that the wheel carries times
/// its squared radius. The forces of the tires would accelerate lighter parts too fast for the time step.
void set_carried_inertia(const RobotDescription& robot, const WheelGeometry& wheel, mjModel& physics) {
  constexpr double kRatio = 0.01;
  const double inertia_kgm2 =
      kRatio * robot.mass_kg / static_cast<double>(robot.wheels.size()) * wheel.radius_m * wheel.radius_m;
  const int body = find(physics, mjOBJ_BODY, wheel.link, robot);
  const auto set = [&](int of_body) {
    double& armature = physics.dof_armature[physics.body_dofadr[of_body]];
    armature = std::max(armature, inertia_kgm2);
  };
  if (!wheel.drive_joint) set(body);
  if (wheel.is_caster) set(physics.body_parentid[body]);
}

}  // namespace

WheelDrive::WheelDrive(const RobotDescription& robot, const WheelDriveSettings& settings, double ticks_per_rad,
                       mjModel& physics, const WheelErrors& errors)
    : initial_(robot, settings, ticks_per_rad, physics.opt.timestep),
      controller_(initial_),
      rollers_(robot, settings, physics) {
  for (const std::string& joint : robot.joint_names) motors_.push_back(find(physics, mjOBJ_ACTUATOR, joint, robot));
  for (std::size_t joint = 0; joint < robot.joint_names.size(); ++joint) {
    const int id = find(physics, mjOBJ_JOINT, robot.joint_names[joint], robot);
    physics.dof_armature[physics.jnt_dofadr[id]] = rotor_inertia_kgm2(robot, settings, joint);
  }
  for (const WheelGeometry& wheel : robot.wheels) set_carried_inertia(robot, wheel, physics);
  const DataPtr scratch = make_data(physics);
  mj_setConst(&physics, scratch.get());
  set_tires(robot, settings, errors, physics);
  for (const WheelGeometry& wheel : robot.wheels) {
    if (!wheel.drive_joint) continue;
    const int id = find(physics, mjOBJ_JOINT, robot.joint_names[*wheel.drive_joint], robot);
    const int dof = physics.jnt_dofadr[id];
    const double brake_nm = settings.brake_torque_ratio * robot.joint_limits[*wheel.drive_joint].effort_nm;
    brakes_.push_back(
        {.dof = dof, .open_nm = physics.dof_frictionloss[dof], .closed_nm = physics.dof_frictionloss[dof] + brake_nm});
  }
}

void WheelDrive::step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel& physics,
                      mjData& data) {
  const WheelDriveCommand drive_command = controller_.step(readings.imu, readings.joints, command);
  for (std::size_t joint = 0; joint < motors_.size(); ++joint)
    data.ctrl[motors_[joint]] = drive_command.torque_nm[joint];
  for (const Brake& brake : brakes_)
    physics.dof_frictionloss[brake.dof] = drive_command.is_brake_closed ? brake.closed_nm : brake.open_nm;
}

void WheelDrive::evaluate(const mjModel& physics, mjData& data) const {
  if (rollers_.is_empty()) Locomotion::evaluate(physics, data);
  else rollers_.evaluate(physics, data);
}

}  // namespace patrol::sim
