#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/run/run_verdict.h"
#include "io/table.h"

namespace patrol::app {

/// One scenario that `patrol test` runs.
struct TestedScenario {
  std::string name;            ///< path below the folder, without ".yaml"
  std::filesystem::path file;
  std::string address;         ///< of its result: "0007_street_patrol"
  std::vector<std::pair<std::string, std::string>> properties;  ///< for JUnit: world, robot, seed, build; of a file that cannot be read, the build
  std::optional<RunVerdict> verdict;  ///< none before it has run
};

bool is_passed(const TestedScenario& tested);

/// Every *.yaml file in the folder and those below it, by name, or the one file. Throws InputError when there is nothing of that name.
std::vector<TestedScenario> find_scenarios(const std::filesystem::path& scenarios, const std::vector<std::string>& overrides);

/// junit.xml, one suite a scenario; those without a verdict are errors.
void save_test_junit(const std::filesystem::path& file, const std::vector<TestedScenario>& tested);

/// One row a scenario: how it ended, and what was measured of what was expected.
io::Table tests_table(const std::vector<TestedScenario>& tested);

/// A page for people, in Markdown as code hosts show it beside a run: the verdict first, what failed and why, then all.
std::string tests_summary(const std::vector<TestedScenario>& tested);

}  // namespace patrol::app
