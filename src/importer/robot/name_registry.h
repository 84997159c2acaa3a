#pragma once

#include <array>
#include <map>
#include <set>
#include <string>

namespace patrol::importer {

/// Sensor frames of Patrol.
inline constexpr std::array kSensorFrames = {"lidar", "lidar_rear",   "lidar3d", "imu",
                                             "gnss",  "depth_camera", "tdlas",   "uwb"};

/// Set of names that are used once.
class NameRegistry {
 public:
  /// Reserves and returns a name that is not used yet: the wanted one, or one with the suffix and a number.
  std::string unique(const std::string& wanted, const std::string& suffix);
  void reserve(const std::string& name) { used_.insert(name); }

 private:
  std::set<std::string> used_;
};

/// Returns whether a name of a link has a meaning in Patrol.
bool is_reserved_link(const std::string& name);

bool is_reserved_joint(const std::string& name);

/// Returns a file name of ASCII letters, digits and underscores.
std::string file_stem(const std::string& name);

}  // namespace patrol::importer
