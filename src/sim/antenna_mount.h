#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/random.h"
#include "core/robot_description.h"
#include "core/settings.h"

namespace patrol::sim {

/// Two digital servos after the data sheet of Robotis' MX-64R (emanual.robotis.com: RS-485, contactless encoder of 12 bits, backlash of 20
/// arcmin, 6.0 N m; the torque's limit stands in the URDF). Alignment, gains and the slow approach are assumptions.
struct AntennaSettings {
  double rate_hz = 10.0;                  ///< of the read-back
  double max_speed_radps = 1.0;           ///< that the servos are told to keep to: a loop on a post swings
  double max_acceleration_radps2 = 2.0;
  double stiffness_nm_per_rad = 60.0;     ///< of the position loop
  double damping_nms_per_rad = 6.0;
  double dead_band_deg = 0.1;             ///< a servo that is so near lets go
  double resolution_deg = 0.088;
  double backlash_deg = 0.33;             ///< between the encoder and the coil, whole
  double alignment_std_deg = 0.3;         ///< of a servo on its bracket, for the run
  double latency_s = 0.02;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("rate_hz", self.rate_hz, between(0.1, 500.0));
    visit("max_speed_radps", self.max_speed_radps, between(0.01, 6.0));
    visit("max_acceleration_radps2", self.max_acceleration_radps2, between(0.01, 50.0));
    visit("stiffness_nm_per_rad", self.stiffness_nm_per_rad, between(1.0, 500.0));
    visit("damping_nms_per_rad", self.damping_nms_per_rad, between(0.0, 50.0));
    visit("dead_band_deg", self.dead_band_deg, between(0.0, 5.0));
    visit("resolution_deg", self.resolution_deg, between(0.0, 5.0));
    visit("backlash_deg", self.backlash_deg, between(0.0, 5.0));
    visit("alignment_std_deg", self.alignment_std_deg, between(0.0, 5.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

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
