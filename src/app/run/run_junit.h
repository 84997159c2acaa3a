#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/run/run_verdict.h"
#include "app/scenario/scenario.h"
#include "io/files/junit.h"

namespace patrol::app {

/// Properties that identify a run for reproduction: world, robot, mission, seed, version.
std::vector<std::pair<std::string, std::string>> junit_properties(const Scenario& scenario);

/// Report of a failure, written before the run and replaced at its end.
io::JunitSuite unfinished_suite(const std::string& name,
                                const std::vector<std::pair<std::string, std::string>>& properties);

/// JUnit suite with one case for the end of the run, one per expectation, and one per declared event (skipped if NOT
/// EXECUTED).
io::JunitSuite junit_suite(const std::string& name, const std::vector<std::pair<std::string, std::string>>& properties,
                           const RunVerdict& verdict);

/// End of a run before the end of its mission.
struct EarlyEnd {
  RunStatus status = RunStatus::kFailed;
  std::string message;  ///< message as in RunVerdict
};

/// Reads from the report of a run how it ended early. Returns nullopt for a run whose mission was over, and without a
/// report.
std::optional<EarlyEnd> load_early_end(const std::filesystem::path& junit_xml);

}  // namespace patrol::app
