#pragma once

#include <vector>

#include "sim/as_built/sensor_errors.h"
#include "sim/locomotion/locomotion.h"
#include "sim/locomotion/roller_contact.h"
#include "sim/locomotion/wheel_controller.h"

namespace patrol::sim {

/// Locomotion on wheels: firmware, motors, brakes and tires (tire_contact.h), with rollers on mecanum wheels
/// (roller_contact.h).
class WheelDrive : public Locomotion {
 public:
  /// Sets tires and rotor inertias in `physics`, with the errors of the wheels. `ticks_per_rad`: counts of the joint
  /// encoders per radian. Throws InputError when the model lacks joints or wheels of the robot.
  WheelDrive(const RobotDescription& robot, const WheelDriveSettings& settings, double ticks_per_rad, mjModel& physics,
             const WheelErrors& errors = {});

  void step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel& physics, mjData& data) override;
  void evaluate(const mjModel& physics, mjData& data) const override;
  void restart() override { controller_ = initial_; }
  bool has_fallen() const override { return controller_.has_fallen(); }
  void serialize_state(StateArchive& archive) override;

 private:
  struct Brake {
    int dof;
    double open_nm, closed_nm;  ///< friction of gear and tire, and with the brake
  };

  WheelController initial_, controller_;
  std::vector<int> motors_;  ///< [joint]
  std::vector<Brake> brakes_;
  RollerContact rollers_;
};

}  // namespace patrol::sim
