#include "io/yaml/renamed_keys.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/scenario/scenario.h"
#include "core/error.h"
#include "io/yaml/renamed_settings.h"
#include "io/yaml/yaml_document.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::renamed_keys_test {
namespace {

using ::testing::EndsWith;
using ::testing::ThrowsMessage;

/// Adds the paths of all keys of a map and of the maps in it.
void add_paths(const YAML::Node& map, const std::string& prefix, std::set<std::string>& paths) {
  for (const auto& entry : map) {
    const std::string path = prefix + entry.first.Scalar();
    paths.insert(path);
    if (entry.second.IsMap()) add_paths(entry.second, path + ".", paths);
  }
}

std::set<std::string> scenario_paths() {
  const test::TemporaryFolder folder;
  save_scenario(folder / "scenario.yaml", Scenario{}, "");
  std::set<std::string> paths;
  add_paths(io::load_yaml(folder / "scenario.yaml"), "", paths);
  return paths;
}

bool is_of_scenario(std::string_view path) {
  for (const std::string_view section : {"stack.", "sensors.", "track_drive.", "low_obstacles.", "teleop.", "light."}) {
    if (path.starts_with(section)) return true;
  }
  return false;
}

TEST(RenamedKeys, EveryPresentPathOfAScenarioExistsAndNoFormerOneDoes) {
  const std::set<std::string> paths = scenario_paths();
  int num_checked = 0;
  for (const auto& keys : {io::renamed_scenario_keys(), io::renamed_stack_keys()}) {
    for (const io::RenamedKey& key : keys) {
      if (!is_of_scenario(key.now)) continue;
      EXPECT_TRUE(paths.contains(std::string(key.now))) << key.before << " -> " << key.now;
      EXPECT_FALSE(paths.contains(std::string(key.before))) << key.before;
      ++num_checked;
    }
  }
  EXPECT_GE(num_checked, 250);
}

TEST(RenamedKeys, APresentPathIsNotRenamed) {
  for (const std::string& path : scenario_paths()) EXPECT_EQ(io::renamed_setting(path), path);
}

TEST(RenamedKeys, AFormerKeyIsRefusedWithItsPresentPath) {
  const std::filesystem::path file = std::filesystem::path(PATROL_SOURCE_DIR) / "worlds/street/scenarios/short.yaml";
  EXPECT_THAT([&] { load_scenario(file, {"stack.plan.patience_s=3"}); },
              ThrowsMessage<InputError>(EndsWith("stack.plan: renamed to stack.navigation")));
  EXPECT_THAT([&] { load_scenario(file, {"stack.navigation.patience_s=3"}); },
              ThrowsMessage<InputError>(
                  EndsWith("--set stack.navigation.patience_s=3: renamed to stack.navigation.blocked_timeout_s")));
  EXPECT_THAT(
      [&] { load_scenario(file, {"stack.slam.particles=3"}); },
      ThrowsMessage<InputError>(EndsWith("--set stack.slam.particles=3: renamed to stack.slam.rbpf.particles")));
}

}  // namespace
}  // namespace patrol::app::renamed_keys_test
