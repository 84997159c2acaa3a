#pragma once

#include <algorithm>

#include "sim/locomotion/locomotion.h"
#include "sim/locomotion/quadruped_controller.h"

namespace patrol::sim {

/// Locomotion on four legs; the controller's torques are the motor torques.
class QuadrupedDrive : public Locomotion {
 public:
  QuadrupedDrive(const RobotDescription& robot, const LocomotionSettings& settings)
      : initial_(robot, settings), controller_(initial_) {}

  void step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel&, mjData& data) override {
    const JointTorques torques =
        controller_.step({.imu = readings.imu, .joints = readings.joints, .feet = readings.feet}, command);
    std::copy(torques.begin(), torques.end(), data.ctrl);
  }
  void restart() override { controller_ = initial_; }
  bool has_fallen() const override { return controller_.has_fallen(); }

 private:
  QuadrupedController initial_, controller_;
};

}  // namespace patrol::sim
