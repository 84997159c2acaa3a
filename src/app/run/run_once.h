#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/record/run_directory.h"
#include "app/run/run_loop.h"
#include "app/run/run_verdict.h"

namespace patrol::app {

/// Scores a run whose log is complete, and completes its directory. `name`: of the scenario.
RunVerdict complete_run(const RunDirectory& directory, const Scenario& scenario, const std::string& name,
                        const ScenarioFiles& files, const RunOutcome& outcome);

/// Runs a scenario, scores it, and writes a complete run directory at `root`. Returns none if `observer` stopped the
/// run: the directory stays marked incomplete. Throws InputError, before anything is written, if a file of the scenario
/// is missing or its settings are inconsistent.
std::optional<RunVerdict> run_once(const Scenario& scenario, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer);

/// Same, with files that are loaded already, such as those of another world.
std::optional<RunVerdict> run_once(const Scenario& scenario, const ScenarioFiles& files, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer);

}  // namespace patrol::app
