#include "app/scenario/lidar_preset.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/mounts.h"
#include "core/error.h"
#include "core/text.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

constexpr std::array kLidarSensors = {"lidar", "lidar_rear", "lidar3d"};

/// Visitor that collects the presets of the program.
struct ProgramPresets {
  std::vector<std::string> names = {};
  template <typename Value>
  void operator()(const char* name, const Value&, const Limits& limits = {}) {
    if (std::string_view(name) == "preset") names = limits.allowed;
  }
};

bool is_lidar(std::string_view sensor) { return std::ranges::find(kLidarSensors, sensor) != kLidarSensors.end(); }

bool is_of_program(const std::string& name) {
  const std::vector<std::string> names = lidar_preset_names();
  return std::ranges::find(names, name) != names.end();
}

bool is_path(const std::string& name) { return name.ends_with(".yaml") || name.ends_with(".yml"); }

/// File of a preset that is not one of the program; none if there is no such file.
std::optional<std::filesystem::path> preset_file(const std::string& name, const std::filesystem::path& data_root) {
  if (is_path(name)) return std::filesystem::is_regular_file(name) ? std::optional(name) : std::nullopt;
  if (name.empty() || name.find('/') != std::string::npos) return std::nullopt;
  for (const std::filesystem::path& root : {data_root, std::filesystem::current_path()}) {
    std::filesystem::path file = root / "models" / "lidars" / (name + ".yaml");
    if (std::filesystem::is_regular_file(file)) return file;
  }
  return std::nullopt;
}

template <typename Settings>
YAML::Node node_of(const Settings& settings) {
  return YAML::Load(io::to_yaml(settings));
}

/// Returns the keys of `defaults` that are missing in `own` (a map, or nothing) together with those of `own`.
YAML::Node completed(const YAML::Node& own, const YAML::Node& defaults) {
  YAML::Node result(YAML::NodeType::Map);
  for (const auto& entry : defaults) {
    if (!own.IsMap() || !own[entry.first.Scalar()].IsDefined()) result[entry.first.Scalar()] = entry.second;
  }
  if (own.IsMap()) {
    for (const auto& entry : own) result[entry.first] = entry.second;
  }
  return result;
}

/// Puts a preset into the sections of a sensor and, for the sensor `lidar`, of its tolerances.
void insert_preset(YAML::Node& document, const std::string& sensor, const LidarPreset& preset) {
  YAML::Node lidar = node_of(preset.lidar);
  lidar.remove("enabled");
  YAML::Node own = find_node(document, {"sensors", sensor});
  if (own.IsMap() && own["preset"].IsDefined()) own["preset"] = preset.lidar.preset;
  document["sensors"][sensor] = completed(own, lidar);
  if (sensor != "lidar") return;
  const YAML::Node tolerances = find_node(document, {"as_built", "lidar"});
  document["as_built"]["lidar"] = completed(tolerances, node_of(preset.as_built));
}

/// Returns the preset of a file that a node names; none for a preset of the program or an unknown name. The file must
/// not have tolerances for a sensor other than `lidar`, because as_built.lidar has no place for them.
std::optional<LidarPreset> named_preset(const std::filesystem::path& file, const YAML::Node& name,
                                        const std::string& key, const std::string& sensor) {
  if (!name.IsDefined() || !name.IsScalar() || is_of_program(name.Scalar())) return std::nullopt;
  const std::optional<std::filesystem::path> found = preset_file(name.Scalar(), find_data_root(file));
  if (found) {
    const YAML::Node tolerances = find_node(io::load_document(*found, {}), {"as_built"});
    if (sensor == "lidar" || !is_lidar(sensor) || !tolerances.IsDefined()) return load_lidar_preset(*found);
    throw InputError(fmt::format("{} = {}: {}: tolerances are those of the frame lidar: must be absent for {}",
                                 location_of(file, name, key), name.Scalar(),
                                 location_of(*found, tolerances, "as_built"), sensor));
  }
  if (!is_path(name.Scalar())) return std::nullopt;
  throw InputError(
      fmt::format("{} = {}: file not found, below the working directory", location_of(file, name, key), name.Scalar()));
}

}  // namespace

std::vector<std::string> lidar_preset_names() {
  ProgramPresets presets;
  const LidarSettings settings;
  LidarSettings::fields(settings, presets);
  return presets.names;
}

LidarPreset load_lidar_preset(const std::filesystem::path& file) {
  LidarPreset preset;
  io::read_settings(file, {}, preset);
  const LidarSettings lidar = preset.lidar;
  preset.as_built = sim::LidarTolerances::for_preset(lidar.preset);
  io::read_settings(file, {}, preset);
  return preset;
}

LidarPreset find_lidar_preset(const std::string& name, const std::filesystem::path& data_root,
                              const std::string& location) {
  if (is_of_program(name))
    return {.lidar = LidarSettings::of_preset(name), .as_built = sim::LidarTolerances::for_preset(name)};
  if (const auto file = preset_file(name, data_root)) return load_lidar_preset(*file);
  throw InputError(fmt::format("{} = {}: must be one of {}, a file models/lidars/NAME.yaml, or the path of a YAML file",
                               location, name, join(lidar_preset_names(), ", ")));
}

void expand_lidar_presets(const std::filesystem::path& file, YAML::Node& document) {
  if (!document.IsMap()) return;
  for (const char* sensor : kLidarSensors) {
    const YAML::Node name = find_node(document, {"sensors", sensor, "preset"});
    if (const auto preset = named_preset(file, name, fmt::format("sensors.{}.preset", sensor), sensor))
      insert_preset(document, sensor, *preset);
  }
  const YAML::Node mounts = find_node(document, {"mounts"});
  if (!mounts.IsDefined() || !mounts.IsSequence()) return;
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    YAML::Node mount = mounts[i];
    if (!mount.IsMap() || !mount["frame"].IsDefined() || !mount["preset"].IsDefined()) continue;
    const std::string frame = mount["frame"].IsScalar() ? mount["frame"].Scalar() : "";
    const auto preset = named_preset(file, mount["preset"], fmt::format("mounts.{}.preset", i), frame);
    if (!preset) continue;
    mount["preset"] = preset->lidar.preset;
    if (is_lidar(frame) && !find_node(document, {"sensors", frame, "preset"}).IsDefined())
      insert_preset(document, frame, *preset);
  }
}

}  // namespace patrol::app
