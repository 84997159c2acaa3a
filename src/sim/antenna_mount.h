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

/// The mount's servos: they turn the joints of the physics, and stow the antenna until they are told otherwise. What the encoder reads is
/// the coil's angle, and the alignment, and half the backlash to the side that the servo has come from, in whole steps.
class AntennaMount {
 public:
  /// Throws InputError when the model has no such joints.
  AntennaMount(const AntennaSettings& settings, const AntennaGeometry& mount, const mjModel& physics, std::uint64_t seed);

  /// Where the servos shall go; what their stops do not let them reach, they stop short of.
  void command(const AntennaCommand& command);

  /// One tick, with the physics evaluated and not yet stepped.
  void step(const mjModel& physics, mjData& data);

  /// The encoders, whenever they are read out.
  std::optional<AntennaState> read(const mjData& data, Time now);

  /// By the encoders: not stowed.
  bool is_out(const mjData& data) const;

 private:
  struct Servo {
    int qpos, dof, motor;
    JointLimit limit;
    double stowed_rad;
    double alignment_rad;
    double target_rad, setpoint_rad, speed_radps = 0.0;
    double slack_rad = 0.0;  ///< half the backlash, on the side that the servo has come from
  };
  double encoder_rad(const Servo& servo, const mjData& data) const;

  AntennaSettings settings_;
  std::array<Servo, 2> servos_;  ///< yaw, pitch
  std::uint64_t count_ = 0;
};

/// Sets the antenna's joints among `qpos` (nq) to where they are stowed, if the model has any.
void stow_antenna(const mjModel& model, mjtNum* qpos);

}  // namespace patrol::sim
