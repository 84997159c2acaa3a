#include "app/scenario/mounts.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/text.h"
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

/// Visitor that collects the names of the presets.
struct PresetNames {
  std::vector<std::string> names = {};
  template <typename Value>
  void operator()(const char* name, Value&, const Limits& limits = {}) {
    if (std::string_view(name) == "preset") names = limits.allowed;
  }
};

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
  LidarSettings* lidar = lidar_of(mount.frame, sensors);
  if (lidar == nullptr)
    throw InputError(fmt::format("{}.preset = {}: only lidars have presets", mount.location, mount.preset));
  PresetNames presets;
  LidarSettings::fields(*lidar, presets);
  std::erase_if(presets.names, [&](const std::string& name) {
    return (LidarSettings::of_preset(name).rings > 1) != (mount.frame == "lidar3d");
  });
  if (std::ranges::find(presets.names, mount.preset) == presets.names.end())
    throw InputError(
        fmt::format("{}.preset = {}: must be one of {}", mount.location, mount.preset, join(presets.names, ", ")));
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
  const int line = node.IsDefined() ? io::line_of(node) : 0;
  return line > 0 ? fmt::format("{}:{}: {}", file.string(), line, key) : fmt::format("{}: {}", file.string(), key);
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

void mount_sensor(const MountSettings& mount, sim::SensorSuiteSettings& sensors) {
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if constexpr (HasSensorSettings<Message>) {
      constexpr const SensorInfo& kInfo = SensorTraits<Message>::kInfo;
      auto& own = sensors.*SensorTraits<Message>::kSettings;
      if constexpr (requires { own.enabled; }) {
        if (mount.frame == kInfo.name || (is_ultrasonic(mount.frame) && is_ultrasonic(kInfo.frame))) own.enabled = true;
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

}  // namespace patrol::app
