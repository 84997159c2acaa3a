#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "core/sensors/lidar.h"
#include "sim/as_built/as_built_settings.h"

namespace patrol::app {

/// Preset of a lidar in a file: what differs from one of the presets of the program (`lidar.preset`), and the as-built
/// tolerances of the device, with its measured systematic errors. `patrol calibrate --sensor lidar` writes one.
struct LidarPreset {
  LidarSettings lidar = LidarSettings::of_preset("rplidar_s2");  ///< settings of sensors.lidar
  sim::LidarTolerances as_built;                                 ///< settings of as_built.lidar

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lidar", self.lidar);
    visit("as_built", self.as_built);
  }
};

/// Names of the presets of the program.
std::vector<std::string> lidar_preset_names();

/// Reads a preset file. Throws InputError with file, line and key.
LidarPreset load_lidar_preset(const std::filesystem::path& file);

/// Returns the preset of a name: one of the program; models/lidars/NAME.yaml below the data root or the working
/// directory; or a path of a YAML file (.yaml, .yml) relative to the working directory. Throws InputError; messages
/// begin with `location`.
LidarPreset find_lidar_preset(const std::string& name, const std::filesystem::path& data_root,
                              const std::string& location);

/// Replaces the names of preset files in the document of a scenario or a robot profile (`sensors.*.preset`,
/// `mounts.*.preset`) by the preset that the file is based on, with its values as keys of `sensors.*`. The values of
/// the file's as-built tolerances become keys of `as_built.lidar`, for the sensor `lidar`; for another sensor, a file
/// with tolerances is refused. Keys of the document win. Names that neither the program nor a file has stay, for the
/// reader to refuse. Throws InputError with file, line and key.
void expand_lidar_presets(const std::filesystem::path& file, YAML::Node& document);

}  // namespace patrol::app
