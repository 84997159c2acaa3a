#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/random.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/settings.h"

namespace patrol::sim {

/// Servos of the antenna mount. They drive the joints of the physics model and keep the antenna stowed until a command
/// arrives.
///
/// Encoder reading: coil angle + alignment + half the backlash toward the side of the last motion, quantized.
class AntennaMount {
 public:
  /// Throws InputError when the model has no such joints.
  AntennaMount(const AntennaSettings& settings, const AntennaGeometry& mount, const mjModel& physics,
               std::uint64_t seed);

  /// Sets the target direction, clamped to the joint limits.
  void command(const AntennaCommand& command);

  /// Advances the servos by one tick, after the physics is evaluated and before it is stepped.
  void step(const mjModel& physics, mjData& data);

  /// Returns the encoder readings if a reading is due.
  std::optional<AntennaState> read(const mjData& data, Time now);

  /// Returns whether the antenna is not stowed, according to the encoders.
  bool is_deployed(const mjData& data) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(servos_, count_);
  }

 private:
  struct Servo {
    int qpos = 0, dof = 0, motor = 0;
    JointLimit limit;
    double stowed_rad = 0.0;
    double alignment_rad = 0.0;
    double target_rad = 0.0, setpoint_rad = 0.0, speed_radps = 0.0;
    double backlash_rad = 0.0;  ///< half the backlash, signed by the side of the last motion
  };
  double encoder_rad(const Servo& servo, const mjData& data) const;

  AntennaSettings settings_;
  std::array<Servo, 2> servos_;  ///< yaw, pitch
  std::uint64_t count_ = 0;
};

/// Sets the antenna joints in `qpos` (nq) to their stowed angles if the model has an antenna.
void stow_antenna(const mjModel& model, mjtNum* qpos);

}  // namespace patrol::sim
