#pragma once

#include <string>
#include <vector>

#include "app/scenario.h"

namespace patrol::app {

/// Something that keeps a run from being perfect, and the settings that take it away and leave all else as it is:
/// every random number is addressed, so that no other draw moves (core/random.h).
struct Imperfection {
  std::string name;
  std::vector<std::string> overrides;  ///< "path=value"
  /// Whether the scenario has it at all: a sensor that is switched off has no noise.
  bool (*is_there)(const Scenario&, const ScenarioFiles&) = [](const Scenario&, const ScenarioFiles&) { return true; };
};

/// Error sources of the registry's sensors (core/sensors/<name>.h), other error sources of the twin, and two of the
/// stack. A scenario in which one of them is away already is not changed by its overrides.
///
/// "Ideal" means: noise, bias, quantisation and loss are zero; a scan is taken in an instant; the lidar is held
/// level; radio passes walls as if there were none. Two cannot be made ideal and are made small instead, which their
/// names say: belts that slip, and the map's cells.
const std::vector<Imperfection>& imperfections();

}  // namespace patrol::app
