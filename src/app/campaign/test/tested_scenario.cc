#include "app/campaign/test/tested_scenario.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "app/run/run_junit.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/run_hash.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "io/yaml/yaml_document.h"

namespace patrol::app {
namespace {

/// Returns whether a file is of settings of the world or robot in its folder: NAME/NAME.yaml beside NAME.xml or
/// NAME.urdf.
bool is_of_world_or_robot(const std::filesystem::path& file) {
  if (file.stem() != std::filesystem::absolute(file).parent_path().filename()) return false;
  return std::ranges::any_of(std::array{".xml", ".urdf"}, [&](const char* extension) {
    return std::filesystem::exists(std::filesystem::path(file).replace_extension(extension));
  });
}

/// Returns whether a file describes a map of map_server. False for a file that cannot be read.
bool is_map(const std::filesystem::path& file) {
  try {
    const YAML::Node document = io::load_yaml(file);
    return document.IsMap() && document["image"] && document["resolution"];
  } catch (const InputError&) {
    return false;
  }
}

/// Returns whether a file in a folder is a scenario. Other files with its extension are taken for wrong scenarios.
bool is_scenario(const std::filesystem::path& file) {
  const bool is_yaml = file.extension() == ".yaml" || file.extension() == ".yml";
  return is_yaml && !is_of_world_or_robot(file) && !is_map(file);
}

/// Returns the file or folder of a name as for patrol run: WORLD/SCENARIO, or WORLD for all of its scenarios.
std::filesystem::path find_scenarios_of(const std::filesystem::path& name) {
  if (std::filesystem::exists(name)) return name;
  const std::optional<std::string> world = world_of(name);
  return world ? find_world(*world, find_data_root({})).parent_path() / "scenarios" : find_scenario(name);
}

void add_files(const std::filesystem::path& scenarios, std::vector<std::filesystem::path>& files) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(scenarios, ignored)) {
    files.push_back(scenarios);
    return;
  }
  if (!std::filesystem::is_directory(scenarios, ignored))
    throw InputError(fmt::format("{}: not found", scenarios.string()));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scenarios)) {  // follows no folder links
    if (entry.is_regular_file(ignored) && is_scenario(entry.path())) files.push_back(entry.path());
  }
}

std::vector<std::filesystem::path> files_of(const std::vector<std::filesystem::path>& scenarios) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : scenarios) add_files(path, files);
  const auto absolute = [](const std::filesystem::path& file) {
    return std::filesystem::absolute(file).lexically_normal();
  };
  std::sort(files.begin(), files.end(), [&](const auto& a, const auto& b) { return absolute(a) < absolute(b); });
  const auto is_same = [&](const auto& a, const auto& b) { return absolute(a) == absolute(b); };
  files.erase(std::unique(files.begin(), files.end(), is_same), files.end());
  return files;
}

/// Last folder that contains all files: the given one, the only file's, or the common part of their paths.
std::filesystem::path common_folder(const std::vector<std::filesystem::path>& scenarios,
                                    const std::vector<std::filesystem::path>& files) {
  std::error_code ignored;
  if (scenarios.size() == 1 && std::filesystem::is_directory(scenarios.front(), ignored))
    return std::filesystem::absolute(scenarios.front()).lexically_normal();
  std::filesystem::path common;
  for (const std::filesystem::path& file : files) {
    const std::filesystem::path folder = std::filesystem::absolute(file).lexically_normal().parent_path();
    if (common.empty()) common = folder;
    const auto end = std::mismatch(common.begin(), common.end(), folder.begin(), folder.end()).first;
    std::filesystem::path shared;
    for (auto part = common.begin(); part != end; ++part) shared /= *part;
    common = shared;
  }
  return common;
}

std::vector<std::pair<std::string, std::string>> properties_of(const std::filesystem::path& file,
                                                               const std::vector<std::string>& overrides,
                                                               const std::string& build) {
  std::vector<std::pair<std::string, std::string>> properties;
  try {
    properties = junit_properties(load_scenario(file, overrides));
  } catch (const InputError&) {
    // The run will report the error.
  }
  properties.emplace_back("build", build);
  properties.emplace_back("scenario", file.string());
  return properties;
}

/// Result name in characters that are valid in every file system.
std::string key_of(std::size_t index, std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-'; }, '_');
  return fmt::format("{:04}_{}", index + 1, name);
}

std::string in_a_cell(const std::string& text) {
  std::string cell;
  for (const char c : text) {
    if (c == '|') cell += '\\';
    cell += c == '\n' ? ' ' : c;
  }
  return cell;
}

std::string line_of(const TestedScenario& tested) {
  const RunVerdict& verdict = *tested.verdict;
  const auto seconds = io::metric_at(verdict.metrics, "performance.wall_s");
  return fmt::format("| {} | {} | {} | {} |\n",
                     is_passed(tested) ? "passed" : fmt::format("**{}**", name_of(verdict.end)), in_a_cell(tested.name),
                     seconds ? fmt::format("{:.1f}", *seconds) : "", in_a_cell(verdict.message));
}

}  // namespace

bool is_passed(const TestedScenario& tested) { return tested.verdict && tested.verdict->code() == ExitCode::kDone; }

std::vector<TestedScenario> find_scenarios(const std::vector<std::filesystem::path>& names,
                                           const std::vector<std::string>& overrides, const SeedTable& seeds) {
  std::vector<std::filesystem::path> scenarios;
  std::transform(names.begin(), names.end(), std::back_inserter(scenarios), find_scenarios_of);
  const std::string build = build_id();
  const std::vector<std::filesystem::path> files = files_of(scenarios);
  const std::filesystem::path folder = common_folder(scenarios, files);
  std::vector<TestedScenario> tested;
  for (const std::filesystem::path& file : files) {
    const std::filesystem::path below =
        std::filesystem::absolute(file).lexically_normal().lexically_relative(folder).replace_extension();
    const std::string name = below.generic_string();
    std::vector<std::string> all;
    if (const auto seed = seeds.seed_of(file)) all.push_back(fmt::format("seed={}", *seed));
    all.insert(all.end(), overrides.begin(), overrides.end());
    tested.push_back({.name = name,
                      .file = file,
                      .overrides = all,
                      .key = key_of(tested.size(), name),
                      .properties = properties_of(file, all, build),
                      .verdict = {}});
  }
  return tested;
}

void save_test_junit(const std::filesystem::path& file, const std::vector<TestedScenario>& tested) {
  std::vector<io::JunitSuite> suites;
  for (const TestedScenario& one : tested) {
    suites.push_back(one.verdict ? junit_suite(one.name, one.properties, *one.verdict)
                                 : unfinished_suite(one.name, one.properties));
  }
  io::save_junit(file, suites);
}

io::Table tests_table(const std::vector<TestedScenario>& tested) {
  io::Table table{.name = "tests",
                  .columns = {"scenario", "end", "exit_code", "message", "metric", "wanted", "got", "is_met"},
                  .rows = {}};
  for (const TestedScenario& one : tested) {
    const std::vector<io::TableValue> head = {one.name, std::string(name_of(one.verdict->end)),
                                              static_cast<std::int64_t>(one.verdict->code()), one.verdict->message};
    if (one.verdict->checks.empty()) {
      table.rows.push_back(head);
      table.rows.back().resize(table.columns.size());
    }
    for (const CheckedExpectation& check : one.verdict->checks) {
      std::vector<io::TableValue>& row = table.rows.emplace_back(head);
      for (const std::string& cell : {check.metric, check.wanted, check.got}) row.emplace_back(cell);
      row.emplace_back(static_cast<std::int64_t>(check.is_met));
    }
  }
  return table;
}

std::string tests_summary(const std::vector<TestedScenario>& tested) {
  const auto num_passed = std::count_if(tested.begin(), tested.end(), is_passed);
  const auto num_failed = static_cast<std::ptrdiff_t>(tested.size()) - num_passed;
  std::string text = num_failed == 0 ? fmt::format("# All {} scenarios passed\n", num_passed)
                                     : fmt::format("# {} of {} scenarios did not pass\n", num_failed, tested.size());
  const std::string head = "\n| result | scenario | s | reason |\n| --- | --- | ---: | --- |\n";
  if (num_failed > 0) {
    text += head;
    for (const TestedScenario& one : tested) {
      if (!is_passed(one)) text += line_of(one);
    }
  }
  if (num_passed > 0) {
    text += head;
    for (const TestedScenario& one : tested) {
      if (is_passed(one)) text += line_of(one);
    }
  }
  return text;
}

}  // namespace patrol::app
