#pragma once

#include <string>
#include <vector>

#include "app/scenario/scenario.h"

namespace patrol::app {

/// Setting of a scenario that differs from the default.
struct SettingDifference {
  std::string path;      ///< "sensors.lidar.range_noise_std_m"
  std::string standard;  ///< empty: an entry of a list that the default does not have
  std::string value;
};

/// Differences in the order of the settings. A sensor of another preset is compared with that preset. Entries of lists
/// (leaks, actors, faults) take one line each, without their defaults. `expect` is omitted, because it does not
/// influence the run.
std::vector<SettingDifference> settings_differences(const Scenario& standard, const Scenario& scenario);

}  // namespace patrol::app
