#include "app/campaign/test/tested_scenario.h"

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include "app/campaign/batch/run_hash.h"
#include "app/run/run_junit.h"
#include "app/scenario/scenario.h"
#include "core/error.h"

namespace patrol::app {
namespace {

bool is_scenario(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& scenarios) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(scenarios, ignored)) return {scenarios};
  if (!std::filesystem::is_directory(scenarios, ignored))
    throw InputError(fmt::format("{}: not found", scenarios.string()));
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scenarios)) {  // follows no folder links
    if (entry.is_regular_file(ignored) && is_scenario(entry.path())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
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

std::vector<TestedScenario> find_scenarios(const std::filesystem::path& scenarios,
                                           const std::vector<std::string>& overrides) {
  const std::string build = build_id();
  std::vector<TestedScenario> tested;
  for (const std::filesystem::path& file : files_of(scenarios)) {
    const bool is_alone = file == scenarios;
    const std::string name =
        (is_alone ? file.filename() : file.lexically_relative(scenarios)).replace_extension().generic_string();
    tested.push_back({.name = name,
                      .file = file,
                      .key = key_of(tested.size(), name),
                      .properties = properties_of(file, overrides, build),
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
