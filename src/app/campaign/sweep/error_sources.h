#pragma once

#include <string>
#include <vector>

#include "app/scenario/scenario.h"

namespace patrol::app {

/// Error source of a run, with the overrides that remove it and change nothing else. Random numbers are counter-based,
/// so that no other sample changes (core/random.h).
struct ScenarioErrorSource {
  std::string name;
  std::vector<std::string> overrides;  ///< "path=value"
  /// Whether the scenario has this error source: a sensor that is switched off has no noise.
  bool (*applies)(const Scenario&, const ScenarioFiles&) = [](const Scenario&, const ScenarioFiles&) { return true; };
};

/// Error sources of the registered sensors (core/sensors/<name>.h), other error sources of the simulator, and two of
/// the stack. The overrides do not change a scenario in which the error source is already absent.
///
/// "Ideal" means: noise, bias, quantization and loss are zero; a scan is instantaneous; the lidar is level; radio
/// passes through walls. Two error sources can only be reduced, as their names indicate: slipping tracks, and the map's
/// resolution.
const std::vector<ScenarioErrorSource>& scenario_error_sources();

}  // namespace patrol::app
