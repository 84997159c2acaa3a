#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/campaign/test/seed_table.h"
#include "app/run/run_verdict.h"
#include "io/files/table.h"

namespace patrol::app {

/// Scenario that `patrol test` runs.
struct TestedScenario {
  std::string name;  ///< path below the folder, or below the last folder that contains all, without ".yaml"
  std::filesystem::path file;
  std::vector<std::string> overrides;                           ///< "path=value"
  std::string key;                                              ///< name of its result: "0007_street_patrol"
  std::vector<std::pair<std::string, std::string>> properties;  ///< properties for JUnit: world, robot, seed, build
  std::optional<RunVerdict> verdict;                            ///< none before the run
};

bool is_passed(const TestedScenario& tested);

/// Every *.yaml file in the folders and their subfolders but settings of worlds and robots and maps of map_server, and
/// the files themselves, each once, sorted by path. Names are folders, files, worlds (all scenarios of the world) or
/// WORLD/SCENARIO. Seeds are those of the table, if it has them. Overrides come after the table. Throws InputError if a
/// name is not found.
std::vector<TestedScenario> find_scenarios(const std::vector<std::filesystem::path>& names,
                                           const std::vector<std::string>& overrides, const SeedTable& seeds = {});

/// Writes junit.xml, one suite per scenario; scenarios without a verdict are errors.
void save_test_junit(const std::filesystem::path& file, const std::vector<TestedScenario>& tested);

/// Table with one row per scenario: its status, and measured values of its expectations.
io::Table tests_table(const std::vector<TestedScenario>& tested);

/// Summary in Markdown as displayed by code hosts: the verdict, failures with their reasons, then all scenarios.
std::string tests_summary(const std::vector<TestedScenario>& tested);

}  // namespace patrol::app
