#include "importer/robot/normalize_lidars.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "core/sensors/lidar.h"

namespace patrol::importer {
namespace {

/// Number in the settings of a lidar.
struct LidarKey {
  double value = 0.0;
  Limits limits = {};
  bool is_integer = false;
};

/// Visitor that collects the numbers of the settings of a lidar by their keys.
class LidarKeys {
 public:
  explicit LidarKeys(const std::string& preset) {
    const LidarSettings settings = LidarSettings::of_preset(preset);
    LidarSettings::fields(settings, *this);
  }

  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& limits = {}) {
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>)
      keys_[name] = {static_cast<double>(value), limits, std::is_integral_v<Value>};
  }

  const LidarKey& at(const std::string& name) const { return keys_.at(name); }

 private:
  std::map<std::string, LidarKey> keys_;
};

/// Preset with its distance from the numbers of a file.
struct PresetChoice {
  std::string name;
  bool agrees = false;  ///< in field of view and range, which the file states
};

/// Returns the preset that agrees with the numbers of a file, otherwise the nearest one; of equal ones the default.
PresetChoice choose_preset(const LidarNumbers& stated, bool is_3d) {
  constexpr double kFov_deg = 5.0, kRange = 0.1;
  constexpr double kFovScale_deg = 90.0;  // difference that counts like a factor of e in range
  const auto fov = stated.find("fov_deg"), range = stated.find("range_max_m");
  PresetChoice nearest;
  double min_distance = std::numeric_limits<double>::infinity();
  for (const char* name : {"rplidar_s2", "utm30lx", "tim571", "vlp16"}) {
    const LidarSettings preset = LidarSettings::of_preset(name);
    if ((preset.rings > 1) != is_3d) continue;
    const double fov_deg = fov == stated.end() ? 0.0 : std::abs(preset.fov_deg - fov->second);
    const double ratio = range == stated.end() ? 1.0 : preset.range_max_m / range->second;
    if (fov != stated.end() && range != stated.end() && fov_deg <= kFov_deg && std::abs(ratio - 1.0) <= kRange)
      return {name, true};
    const double distance = fov_deg / kFovScale_deg + (ratio > 0.0 ? std::abs(std::log(ratio)) : 0.0);
    if (distance >= min_distance) continue;
    min_distance = distance;
    nearest.name = name;
  }
  return nearest;
}

std::string number_text(double value, bool is_integer) {
  return is_integer ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

/// Returns why a file determines no preset.
std::string reason_of(const LidarNumbers& stated) {
  std::vector<std::string> parts;
  if (const auto fov = stated.find("fov_deg"); fov != stated.end())
    parts.push_back(fmt::format("its field of view of {:.0f} degrees", fov->second));
  if (const auto range = stated.find("range_max_m"); range != stated.end())
    parts.push_back(fmt::format("its range of {:.3g} m", range->second));
  if (parts.empty()) return "the file states neither its field of view nor its range";
  return parts.size() == 1 ? "the file states only " + parts[0]
                           : fmt::format("no preset has {} and {}", parts[0], parts[1]);
}

}  // namespace

void choose_lidar(const std::string& frame, const LidarNumbers& stated, NormalizedRobot& robot) {
  if (!frame.starts_with("lidar")) return;
  const bool is_3d = frame == "lidar3d";
  const std::string default_preset = choose_preset({}, is_3d).name;
  const PresetChoice choice = choose_preset(stated, is_3d);
  if (choice.agrees) {
    robot.lidars[frame] = "preset: " + choice.name;
    robot.assumptions.push_back({frame,
                                 fmt::format("is simulated as {}, by its field of view and its range", choice.name),
                                 fmt::format("sensors.{}.preset in {}.yaml", frame, robot.name)});
    return;
  }
  const LidarKeys keys(choice.name);
  std::vector<std::string> settings, impossible;
  for (const auto& [name, value] : stated) {
    constexpr double kSame = 0.005;
    const LidarKey& key = keys.at(name);
    const std::string setting = fmt::format("{}: {}", name, number_text(value, key.is_integer));
    if (std::abs(value - key.value) <= kSame * std::max(1.0, std::abs(key.value))) continue;
    (allows(key.limits, value) ? settings : impossible).push_back(setting);
  }
  robot.assumptions.push_back(
      {frame,
       fmt::format("is simulated as {} ({:.0f} degrees, {:g} m){}: {}{}", choice.name, keys.at("fov_deg").value,
                   keys.at("range_max_m").value, settings.empty() ? "" : " with " + list_of(settings) + " of the file",
                   reason_of(stated),
                   impossible.empty() ? "" : "; outside of the limits of the key: " + list_of(impossible)),
       fmt::format("sensors.{} in {}.yaml", frame, robot.name)});
  if (choice.name != default_preset || !settings.empty()) settings.insert(settings.begin(), "preset: " + choice.name);
  if (!settings.empty()) robot.lidars[frame] = list_of(settings);
}

}  // namespace patrol::importer
