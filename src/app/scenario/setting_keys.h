#pragma once

#include <string>
#include <vector>

namespace patrol::app {

/// Settings key of a scenario, for the reference pages.
struct SettingKey {
  std::string path;           ///< "sensors.lidar.rate_hz"; entries of a list: "mounts[].frame"
  std::string owner;          ///< settings struct that declares the field, "patrol::LidarSettings"
  std::string type;           ///< "number", "integer", "text", "true or false", "list", "section" or "expectations"
  std::string default_value;  ///< in YAML; empty for sections and for lists of sections
  std::string limits;         ///< admissible values; empty: any
};

/// All keys of a scenario in the order of `scenario.yaml`, with the defaults of the program. A robot's file changes
/// some of them.
std::vector<SettingKey> setting_keys();

}  // namespace patrol::app
