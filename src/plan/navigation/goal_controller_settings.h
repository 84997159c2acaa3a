#pragma once

#include "core/settings.h"
#include "plan/control/differential_pose_controller_settings.h"
#include "plan/control/pose_regulator_settings.h"

namespace patrol::plan {

/// Settings of the controllers of the last meter to a goal; `kinematics` of the navigation selects one.
struct GoalControllerSettings {
  PoseRegulatorSettings holonomic;                  ///< omnidirectional robot
  DifferentialPoseControllerSettings differential;  ///< differential robot

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("holonomic", self.holonomic);
    visit("differential", self.differential);
  }
};

}  // namespace patrol::plan
