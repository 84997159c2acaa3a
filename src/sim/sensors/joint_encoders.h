#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/as_built/sensor_errors.h"

namespace patrol::sim {

class JointEncoders {
 public:
  JointEncoders(const JointEncoderSettings& settings, const mjModel& model, const std::vector<std::string>& joint_names,
                JointErrors errors = {});

  /// Takes the reading of one tick. Call at every tick.
  JointState read(const mjData& data, Time now);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(last_);
  }

 private:
  double error_rad(std::size_t joint, const mjData& data) const;

  JointErrors errors_;
  double step_rad_;
  double tick_s_;
  double filter_gain_;
  std::vector<int> qpos_, dof_;  ///< indices in MuJoCo's state, [joint]
  JointState last_;
};

}  // namespace patrol::sim
