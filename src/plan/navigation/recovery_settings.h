#pragma once

#include <string>
#include <vector>

#include "core/settings.h"

namespace patrol::plan {

struct RecoverySettings {
  /// Recovery behaviors in their order: wait, clear_costmap, back_up, spin.
  std::vector<std::string> behaviors = {"back_up"};
  int max_attempts = 8;             ///< recoveries without progress after which the goal is aborted
  double back_up_duration_s = 2.0;  ///< duration of backing up, if there is room
  double back_up_speed_mps = 0.15;  ///< speed of the behavior back_up

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("behaviors", self.behaviors, one_of({"wait", "clear_costmap", "back_up", "spin"}));
    visit("max_attempts", self.max_attempts, between(0, 1000));
    visit("back_up_duration_s", self.back_up_duration_s, between(0.0, 20.0));
    visit("back_up_speed_mps", self.back_up_speed_mps, between(0.0, 1.0));
  }
};

}  // namespace patrol::plan
