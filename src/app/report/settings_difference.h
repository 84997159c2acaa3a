#pragma once

#include <string>
#include <vector>

#include "app/scenario.h"

namespace patrol::app {

/// A setting that a scenario has otherwise than the standard.
struct SettingDifference {
  std::string path;      ///< "sensors.lidar.range_noise_m"
  std::string standard;  ///< empty: an entry of a list that the standard does not have
  std::string value;
};

/// In the order of the settings. A sensor of another preset is compared with that preset; entries of lists (leaks, actors, faults) are
/// told in a line each, without what is default in them. `expect` is left out: it is no setting of the run.
std::vector<SettingDifference> settings_differences(const Scenario& standard, const Scenario& scenario);

}  // namespace patrol::app
