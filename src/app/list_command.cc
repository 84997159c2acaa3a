#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/scenario.h"
#include "app/study/study.h"
#include "plan/routes/planners.h"
#include "slam/mapper.h"

namespace patrol::app {
namespace {

/// Files below `folder` that `keep` accepts, as paths relative to `root`, sorted.
template <typename Keep>
std::vector<std::string> files_below(const std::filesystem::path& root, const std::string& folder, const Keep& keep) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    std::error_code ignored;  // of a link that leads to itself
    if (entry.is_regular_file(ignored) && keep(entry.path())) found.push_back(std::filesystem::relative(entry.path(), root).string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void print(const char* title, const std::vector<std::string>& lines) {
  fmt::print("{}\n", title);
  for (const std::string& line : lines) fmt::print("  {}\n", line);
}

/// Collects what the settings allow for one field.
struct AllowedValues {
  std::string wanted;
  std::vector<std::string> values;
  template <typename Value>
  void operator()(const char* name, Value&, const Limits& limits = {}) {
    if (name == wanted) values = limits.allowed;
  }
};

template <typename Settings>
std::vector<std::string> allowed(const std::string& field) {
  AllowedValues visitor{.wanted = field, .values = {}};
  const Settings settings;
  Settings::fields(settings, visitor);
  return visitor.values;
}

/// Scenarios, worlds and robots. A program without its data lists everything else.
void print_data() {
  std::filesystem::path root;
  try {
    root = find_data_root("");
  } catch (const InputError& error) {
    fmt::print("scenarios, worlds, robots\n  none: {}\n", error.what());
    return;
  }
  print("scenarios", files_below(root, "worlds", [](const auto& file) { return file.parent_path().filename() == "scenarios"; }));
  print("worlds", files_below(root, "worlds", [](const auto& file) {
          return file.extension() == ".xml" && file.stem() == file.parent_path().filename();
        }));
  print("robots", files_below(root, "models", [](const auto& file) { return file.extension() == ".urdf"; }));
}

}  // namespace

ExitCode list_command() {
  print_data();
  print("sensors", allowed<sim::FaultSettings>("sensor"));
  print("lidar presets", allowed<sim::LidarSettings>("preset"));
  print("sensor faults", allowed<sim::FaultSettings>("kind"));
  print("mapping methods of a run (stack.mapping)", allowed<StackSettings>("mapping"));
  print("mapping methods of a log", allowed<slam::MapperSettings>("method"));
  print("localisation methods", {"Monte-Carlo localisation with KLD sampling (stack.localization)"});
  print("sensor models of localisation", allowed<localize::MonteCarloSettings>("sensor_model"));
  print("global planners (stack.plan.global; patrol plan --planner)", plan::route_planner_names());
  print("local planners (stack.plan.local_planner)", allowed<plan::NavigatorSettings>("local_planner"));
  print("studies", study_names());
  return ExitCode::kDone;
}

}  // namespace patrol::app
