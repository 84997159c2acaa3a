#pragma once

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/sensors/registry.h"

namespace patrol::sim {

/// What a robot's firmware reads at a tick: the newest of each. What the robot has not got stays empty.
struct FirmwareReadings {
  const Imu& imu;
  const JointState& joints;
  const FootContacts& feet;
  const TrackTicks& ticks;
};

/// How a robot moves: its firmware and its drives.
class Locomotion {
 public:
  virtual ~Locomotion() = default;

  /// One tick, with the physics evaluated and not yet stepped: what the motors do until the next one.
  virtual void step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel& physics, mjData& data) = 0;

  /// The firmware is switched off and on again.
  virtual void restart() = 0;

  /// By the firmware's own sensing.
  virtual bool has_fallen() const = 0;
};

}  // namespace patrol::sim
