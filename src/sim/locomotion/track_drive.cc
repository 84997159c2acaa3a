#include "sim/locomotion/track_drive.h"

namespace patrol::sim {

TrackDrive::TrackDrive(const RobotDescription& robot, const TrackDriveSettings& settings, double ticks_per_rad,
                       mjModel& physics, const TrackErrors& errors)
    : initial_(robot, settings, ticks_per_rad, physics.opt.timestep),
      controller_(initial_),
      contact_(robot, settings.friction, physics, errors),
      brake_torque_nm_(settings.brake_torque_nm) {
  for (std::size_t side = 0; side < motors_.size(); ++side) {
    motors_[side] = mj_name2id(&physics, mjOBJ_ACTUATOR, robot.joint_names[side].c_str());
    gear_friction_nm_[side] = physics.dof_frictionloss[contact_.sprocket_dofs()[side]];
  }
}

void TrackDrive::step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel& physics,
                      mjData& data) {
  const TrackDriveCommand drive_command = controller_.step(readings.imu, readings.ticks, command);
  const std::array<double, 2> contact_torque_nm = contact_.contact_torque_nm(physics, data);
  for (std::size_t side = 0; side < motors_.size(); ++side) {
    const int dof = contact_.sprocket_dofs()[side];
    data.ctrl[motors_[side]] = drive_command.torque_nm[side];
    data.qfrc_applied[dof] = contact_torque_nm[side];
    physics.dof_frictionloss[dof] = gear_friction_nm_[side] + (drive_command.is_brake_closed ? brake_torque_nm_ : 0.0);
  }
  contact_.run(physics, data);
}

}  // namespace patrol::sim
