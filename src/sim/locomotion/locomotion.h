#pragma once

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/state/state_archive_fwd.h"

namespace patrol::sim {

/// Newest sensor readings of the firmware at a tick. Readings of sensors that the robot does not have are empty.
struct FirmwareReadings {
  const Imu& imu;
  const JointState& joints;
  const FootContacts& feet;
  const TrackTicks& ticks;
};

/// Interface of a robot's locomotion: firmware and drives.
class Locomotion {
 public:
  virtual ~Locomotion() = default;

  /// Sets the motors for the next tick. Called after the physics is evaluated and before it is stepped.
  virtual void step(const FirmwareReadings& readings, const VelocityCommand& command, mjModel& physics,
                    mjData& data) = 0;

  /// Evaluates the physics at its state, as mj_forward does. Overridden by drives that change the contacts.
  virtual void evaluate(const mjModel& physics, mjData& data) const { mj_forward(&physics, &data); }

  /// Restarts the firmware.
  virtual void restart() = 0;

  /// Returns whether the robot has fallen, according to the firmware's own sensors.
  virtual bool has_fallen() const = 0;

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& archive) = 0;
};

}  // namespace patrol::sim
