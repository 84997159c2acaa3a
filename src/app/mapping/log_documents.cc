#include "app/mapping/log_documents.h"

#include <algorithm>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/error.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

constexpr const char* kLidarFrame = "lidar";  // frame_id of a LaserScan

}  // namespace

io::TransformSet lidar_mount(const Pose2& T_body_lidar) {
  return {{{.stamp = {}, .parent = frame_id::kBody, .child = kLidarFrame, .T_parent_child = to_pose3(T_body_lidar)}}};
}

Pose2 T_body_lidar_of(const io::TransformSet& mounts) {
  const auto mount = std::ranges::find(mounts.transforms, kLidarFrame, &io::FrameTransform::child);
  if (mount == mounts.transforms.end()) throw InputError("the recorded log has no transform of the lidar");
  return to_pose2(mount->T_parent_child);
}

StackDocuments log_documents(const std::string& name, const LogMappingSettings& settings,
                             const io::TransformSet& mounts) {
  return {.hello = {.program = fmt::format("patrol {}", PATROL_VERSION),
                    .scenario = name,
                    .seed = settings.seed,
                    .tick = Time{1},  // a turn can be at the end of any scan
                    .limits = {},
                    .robot = "",
                    .site = "",
                    .goals = "",
                    .registration = "",
                    .documents = io::to_yaml(settings)},
          .environment = {},
          .static_transforms = io::encode(mounts),
          .known_map = {}};
}

LogMappingSettings mapping_settings_of(const link::Hello& hello) {
  LogMappingSettings settings;
  io::SettingsReader::read_section("documents of the hello", YAML::Load(hello.documents), "", settings);
  return settings;
}

}  // namespace patrol::app
