#include "io/yaml/renamed_settings.h"

#include <algorithm>
#include <array>

namespace patrol::io {
namespace {

struct RenamedKey {
  std::string_view before;  ///< path with its parents as they are today; a leading `*` stands for any parents
  std::string_view now;     ///< full path, or `*` with the same parents
};

constexpr auto kRenamed = std::to_array<RenamedKey>({
    // Sensors, robot and world.

    // Scenario.

    // Stack: odometry and localization.

    // Stack: SLAM; patrol slam, calibrate, train-neighbors.

    // Stack: navigation and docking; patrol plan.
    {"stack.plan", "stack.navigation"},

    // Stack: missions and inspection.

    // Monitor, rendering; patrol plan without navigation.
    {"light.brightness_share", "light.intensity"},
    {"kept_clearance_m", "min_clearance_m"},
    {"any_angle_most_cells", "max_any_angle_cells"},
    {"unknown", "allow_unknown"},
});

/// Returns the present path of a key whose parents carry their present names.
std::string rename_last(const std::string& path) {
  for (const RenamedKey& key : kRenamed) {
    if (key.before == path) return std::string(key.now);
    if (key.before.starts_with("*.") && path.ends_with(key.before.substr(1))) {
      return path.substr(0, path.size() - key.before.size() + 1) + std::string(key.now.substr(1));
    }
  }
  return path;
}

}  // namespace

std::string renamed_setting(std::string_view path) {
  std::string renamed;
  while (!path.empty()) {
    const std::size_t end = std::min(path.find('.'), path.size());
    renamed = rename_last((renamed.empty() ? "" : renamed + ".") + std::string(path.substr(0, end)));
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return renamed;
}

}  // namespace patrol::io
