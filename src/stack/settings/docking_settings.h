#pragma once

#include "core/settings.h"
#include "localize/dock_detector_settings.h"
#include "plan/control/docking_settings.h"

namespace patrol::stack {

/// Settings of the detection of the charging post and of the docking maneuver; those of the maneuver are in the same
/// section as `detector`.
struct DockingSettings {
  localize::DockDetectorSettings detector;
  plan::DockingSettings maneuver;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("detector", self.detector);
    plan::DockingSettings::fields(self.maneuver, visit);
  }
};

}  // namespace patrol::stack
