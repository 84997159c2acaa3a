#pragma once

#include <array>

#include "sim/locomotion/locomotion.h"
#include "sim/locomotion/track_contact.h"
#include "sim/locomotion/track_controller.h"

namespace patrol::sim {

/// Locomotion on two tracks: firmware, motors and brakes on the sprockets, track contact.
class TrackDrive : public Locomotion {
 public:
  /// `ticks_per_rad`: Hall counts per radian of a sprocket.
  TrackDrive(const RobotDescription& robot, const TrackDriveSettings& settings, double ticks_per_rad, mjModel& physics,
             const TrackErrors& errors = {});

  void step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel& physics, mjData& data) override;
  void restart() override { controller_ = initial_; }
  bool has_fallen() const override { return controller_.has_fallen(); }
  void serialize_state(StateArchive& archive) override;

 private:
  TrackController initial_, controller_;
  TrackContact contact_;
  double brake_torque_nm_;
  std::array<double, 2> gear_friction_nm_{};  ///< left, right
  std::array<int, 2> motors_{};
};

}  // namespace patrol::sim
