#include "sim/locomotion/track_drive.h"

namespace patrol::sim {

TrackDrive::TrackDrive(const RobotDescription& robot, const TrackDriveSettings& settings, double ticks_per_rad, mjModel& physics)
    : fresh_(robot, settings, ticks_per_rad, physics.opt.timestep),
      controller_(fresh_),
      belts_(robot, settings.friction, physics),
      brake_torque_nm_(settings.brake_torque_nm) {
  for (std::size_t side = 0; side < motors_.size(); ++side) {
    motors_[side] = mj_name2id(&physics, mjOBJ_ACTUATOR, robot.joint_names[side].c_str());
    gear_friction_nm_[side] = physics.dof_frictionloss[belts_.sprocket_dofs()[side]];
  }
}

void TrackDrive::step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel& physics, mjData& data) {
  const TrackOrders orders = controller_.step(readings.imu, readings.ticks, command);
  const std::array<double, 2> drag_nm = belts_.drag_nm(physics, data);
  for (std::size_t side = 0; side < motors_.size(); ++side) {
    const int dof = belts_.sprocket_dofs()[side];
    data.ctrl[motors_[side]] = orders.torque_nm[side];
    data.qfrc_applied[dof] = drag_nm[side];
    physics.dof_frictionloss[dof] = gear_friction_nm_[side] + (orders.is_brake_closed ? brake_torque_nm_ : 0.0);
  }
  belts_.run(physics, data);
}

}  // namespace patrol::sim
