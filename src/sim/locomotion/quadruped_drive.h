#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/locomotion/locomotion.h"
#include "sim/locomotion/quadruped_controller.h"

namespace patrol::sim {

/// Locomotion on four legs; the controller's torques are the motor torques.
class QuadrupedDrive : public Locomotion {
 public:
  QuadrupedDrive(const RobotDescription& robot, const LocomotionSettings& settings, const mjModel& physics)
      : initial_(robot, settings), controller_(initial_) {
    for (const std::string& joint : robot.joint_names)
      motors_.push_back(mj_name2id(&physics, mjOBJ_ACTUATOR, joint.c_str()));
  }

  void step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel&, mjData& data) override {
    const JointTorques torques =
        controller_.step({.imu = readings.imu, .joints = readings.joints, .feet = readings.feet}, command);
    for (std::size_t joint = 0; joint < motors_.size(); ++joint)
      data.ctrl[motors_[joint]] = torques[static_cast<Eigen::Index>(joint)];
  }
  void restart() override { controller_ = initial_; }
  bool has_fallen() const override { return controller_.has_fallen(); }
  void serialize_state(StateArchive& archive) override;

 private:
  QuadrupedController initial_, controller_;
  std::vector<int> motors_;  ///< [joint]
};

}  // namespace patrol::sim
