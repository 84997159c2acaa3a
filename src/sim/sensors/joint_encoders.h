#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/settings.h"

namespace patrol::sim {

/// Absolute magnetic encoders on the joints, 14 bit, with the drive's own filtered speed.
struct JointEncoderSettings {
  bool enabled = true;
  double rate_hz = 250.0;          ///< of the messages; the firmware reads at every tick
  int counts_per_turn = 16384;
  double speed_filter_s = 0.003;   ///< time constant of the speed, made from differences of counts
  double latency_s = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("counts_per_turn", self.counts_per_turn, between(16, 1 << 24));
    visit("speed_filter_s", self.speed_filter_s, between(0.0, 0.1));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

class JointEncoders {
 public:
  JointEncoders(const JointEncoderSettings& settings, const mjModel& model, const std::vector<std::string>& joint_names);

  /// One reading a tick.
  JointState read(const mjData& data, Time now);

 private:
  double step_rad_;
  double tick_s_;
  double blend_;
  std::vector<int> qpos_, dof_;  ///< [joint]
  JointState last_;
};

}  // namespace patrol::sim
