#include "app/mapping/log_documents.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "io/yaml/settings_yaml.h"

namespace patrol::app {

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
