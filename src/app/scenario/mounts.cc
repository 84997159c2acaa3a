#include "app/scenario/mounts.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/lidar_preset.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/text.h"
#include "io/urdf.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

constexpr std::string_view kUltrasonic = "ultrasonic_";

/// Returns the frames that mounts can add. The antenna has joints of its own, which only a URDF describes.
std::vector<std::string> mountable_frames() {
  std::vector<std::string> frames;
  for (const SensorInfo& info : kSensorInfos) {
    const std::string frame = info.frame;
    if (!frame.empty() && frame != "tem_mount" && std::ranges::find(frames, frame) == frames.end())
      frames.push_back(frame);
  }
  return frames;
}

bool is_ultrasonic(std::string_view frame) {
  if (!frame.starts_with(kUltrasonic) || frame.size() == kUltrasonic.size()) return false;
  return std::ranges::all_of(frame.substr(kUltrasonic.size()), [](char c) { return c >= '0' && c <= '9'; });
}

void check_frame(const MountSettings& mount) {
  const std::vector<std::string> known = mountable_frames();
  if (is_ultrasonic(mount.frame) || std::ranges::find(known, mount.frame) != known.end()) return;
  const std::string nearest = io::closest_match(mount.frame, known);
  throw InputError(fmt::format("{}.frame = {}: unknown frame{}: must be one of {}, ultrasonic_1 ...", mount.location,
                               mount.frame, nearest.empty() ? "" : "; did you mean " + nearest + "?",
                               join(known, ", ")));
}

/// Settings of the lidar of a frame; nullptr for the frame of another sensor.
LidarSettings* lidar_of(const std::string& frame, sim::SensorSuiteSettings& sensors) {
  LidarSettings* found = nullptr;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if constexpr (HasSensorSettings<Message>) {
      auto& own = sensors.*SensorTraits<Message>::kSettings;
      if constexpr (std::is_same_v<decltype(own), LidarSettings&>) {
        if (frame == SensorTraits<Message>::kInfo.frame) found = &own;
      }
    }
  });
  return found;
}

void check_preset(const MountSettings& mount) {
  if (mount.preset.empty()) return;
  sim::SensorSuiteSettings sensors;
  if (lidar_of(mount.frame, sensors) == nullptr)
    throw InputError(fmt::format("{}.preset = {}: only lidars have presets", mount.location, mount.preset));
  std::vector<std::string> presets = lidar_preset_names();
  std::erase_if(presets, [&](const std::string& name) {
    return (LidarSettings::of_preset(name).rings > 1) != (mount.frame == "lidar3d");
  });
  if (std::ranges::find(presets, mount.preset) == presets.end())
    throw InputError(
        fmt::format("{}.preset = {}: must be one of {}", mount.location, mount.preset, join(presets, ", ")));
}

/// Returns the mounts for the reader of URDF files.
std::vector<io::SensorMount> sensor_mounts(const std::vector<MountSettings>& mounts) {
  std::vector<io::SensorMount> result;
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    const MountSettings& mount = mounts[i];
    result.push_back({.frame = mount.frame,
                      .parent = mount.parent,
                      .position_m = {mount.x_m, mount.y_m, mount.z_m},
                      .rpy_rad = kDegree * Eigen::Vector3d(mount.roll_deg, mount.pitch_deg, mount.yaw_deg),
                      .location = mount.location.empty() ? fmt::format("mounts.{}", i) : mount.location});
  }
  return result;
}

/// Returns whether a key is `path` or one below it.
bool is_at_or_below(const std::string& key, const std::string& path) {
  return key.starts_with(path) && (key.size() == path.size() || key[path.size()] == '.');
}

/// Line of the last node of a document on the way to a key, "leaks.0.at"; 0 if the document has none.
int last_line_on(const YAML::Node& document, const std::string& key) {
  YAML::Node node = document;
  int line = 0;
  std::istringstream words(key);
  for (std::string word; std::getline(words, word, '.');) {
    const YAML::Node& parent = node;  // reading a constant node adds no key
    const bool is_number = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    const YAML::Node child = parent.IsMap()                     ? parent[word]
                             : parent.IsSequence() && is_number ? parent[std::stoul(word)]
                                                                : YAML::Node(YAML::NodeType::Undefined);
    if (!child.IsDefined()) break;
    line = io::line_of(child);
    node.reset(child);
  }
  return line;
}

}  // namespace

YAML::Node find_node(const YAML::Node& document, const std::vector<std::string>& path) {
  YAML::Node node = document;
  for (const std::string& key : path) {
    const YAML::Node& parent = node;  // reading a constant node adds no key
    if (!parent.IsDefined() || !parent.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    const YAML::Node child = parent[key];
    if (!child.IsDefined()) return YAML::Node(YAML::NodeType::Undefined);
    node.reset(child);
  }
  return node;
}

std::string location_of(const std::filesystem::path& file, const YAML::Node& node, const std::string& key) {
  if (file.empty()) return key;  // settings of a run without a file
  const int line = node.IsDefined() ? io::line_of(node) : 0;
  return line > 0 ? fmt::format("{}:{}: {}", file.string(), line, key) : fmt::format("{}: {}", file.string(), key);
}

std::string with_location_of_key(const Scenario& scenario, const std::string& message) {
  const std::size_t end = message.find_first_of(": ");
  const std::string key = message.substr(0, end);
  if (key.empty() || end == std::string::npos) return message;
  for (auto override = scenario.overrides.rbegin(); override != scenario.overrides.rend(); ++override) {
    const std::string path = override->substr(0, override->find('='));
    if (is_at_or_below(path, key) || is_at_or_below(key, path)) return fmt::format("--set {}: {}", *override, message);
  }
  if (!std::filesystem::is_regular_file(scenario.file)) return message;
  const int line = last_line_on(io::load_document(scenario.file, {}), key);
  return line > 0 ? fmt::format("{}:{}: {}", scenario.file.string(), line, message) : message;
}

void complete_mounts(const std::filesystem::path& file, const YAML::Node& document,
                     std::vector<MountSettings>& mounts) {
  const YAML::Node list = find_node(document, {"mounts"});
  std::set<std::string> frames;
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    MountSettings& mount = mounts[i];
    mount.location = location_of(file, list.IsDefined() ? list[i] : list, fmt::format("mounts.{}", i));
    check_frame(mount);
    check_preset(mount);
    if (!frames.insert(mount.frame).second)
      throw InputError(
          fmt::format("{}.frame = {}: duplicate frame: must be mounted once", mount.location, mount.frame));
  }
}

std::vector<std::string> sensors_of(const MountSettings& mount) {
  std::vector<std::string> sensors;
  for (const SensorInfo& info : kSensorInfos) {
    if (mount.frame == info.name || (is_ultrasonic(mount.frame) && is_ultrasonic(info.frame)))
      sensors.emplace_back(info.name);
  }
  return sensors;
}

void mount_sensor(const MountSettings& mount, sim::SensorSuiteSettings& sensors) {
  const std::vector<std::string> mounted = sensors_of(mount);
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if constexpr (HasSensorSettings<Message>) {
      auto& own = sensors.*SensorTraits<Message>::kSettings;
      if constexpr (requires { own.enabled; }) {
        if (std::ranges::find(mounted, SensorTraits<Message>::kInfo.name) != mounted.end()) own.enabled = true;
      }
    }
  });
  LidarSettings* lidar = lidar_of(mount.frame, sensors);
  if (lidar != nullptr && !mount.preset.empty()) *lidar = LidarSettings::of_preset(mount.preset);
}

std::vector<MountSettings> merge_mounts(std::vector<MountSettings> of_robot, const std::vector<MountSettings>& own) {
  for (const MountSettings& mount : own) {
    const auto same = std::ranges::find(of_robot, mount.frame, &MountSettings::frame);
    if (same == of_robot.end()) of_robot.push_back(mount);
    else *same = mount;
  }
  return of_robot;
}

LoadedRobot load_robot(const std::string& name, const std::filesystem::path& data_root,
                       const std::vector<MountSettings>& mounts) {
  std::filesystem::path urdf = find_robot(name, data_root);
  io::MountedRobot robot = io::load_mounted_robot(urdf.string(), sensor_mounts(mounts));
  return {.urdf_file = std::move(urdf), .urdf = std::move(robot.urdf), .description = std::move(robot.description)};
}

}  // namespace patrol::app
