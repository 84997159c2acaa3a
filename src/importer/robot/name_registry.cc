#include "importer/robot/name_registry.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace patrol::importer {

std::string NameRegistry::unique(const std::string& wanted, const std::string& suffix) {
  std::string name = wanted;
  for (int i = 2; used_.contains(name); ++i)
    name = i == 2 ? wanted + suffix : fmt::format("{}{}_{}", wanted, suffix, i - 1);
  used_.insert(name);
  return name;
}

bool is_reserved_link(const std::string& name) {
  static const std::set<std::string> kReserved = {
      "base_link",   "world",         "scanner",        "tem_mount",      "tem", "left_track",
      "right_track", "left_sprocket", "right_sprocket", "base_footprint", "map", "odom"};
  return kReserved.contains(name) ||
         std::find(kSensorFrames.begin(), kSensorFrames.end(), name) != kSensorFrames.end() ||
         name.starts_with("ultrasonic_");
}

bool is_reserved_joint(const std::string& name) { return name.starts_with("tem_") || name == "robot"; }

std::string file_stem(const std::string& name) {
  std::string stem;
  for (const char c : name) {
    const bool is_plain =
        static_cast<unsigned char>(c) < 128 && (std::isalnum(static_cast<unsigned char>(c)) || c == '-');
    if (is_plain) stem += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!stem.ends_with('_')) stem += '_';
  }
  return stem.empty() || stem == "_" ? "mesh" : stem;
}

}  // namespace patrol::importer
