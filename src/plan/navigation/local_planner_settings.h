#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/named_table.h"
#include "core/settings.h"
#include "plan/control/dwa_liu21_settings.h"
#include "plan/control/dwa_settings.h"
#include "plan/control/local_planner.h"

namespace patrol::plan {

struct LocalPlannerSettings;

/// Table of local planners; `make` takes the settings of its own section.
std::span<const NamedFactory<std::unique_ptr<LocalPlanner>(const LocalPlannerSettings&)>> local_planners();

struct LocalPlannerSettings {
  std::string method = "dwa";  ///< method of the local planner: "dwa", or "dwa_liu21" as printed in [Liu21]
  DwaSettings dwa;
  DwaLiu21Settings dwa_liu21;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("method", self.method, one_of(local_planners()));
    visit("dwa", self.dwa);
    visit("dwa_liu21", self.dwa_liu21);
  }
};

}  // namespace patrol::plan
