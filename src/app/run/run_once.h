#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/run/run_loop.h"
#include "app/run/run_verdict.h"

namespace patrol::app {

/// Runs a scenario, scores it, and leaves a complete run directory at `root`; none when `observer` stopped it: the directory stays
/// marked incomplete. Throws InputError before anything is written when what the scenario names is missing or does not go together.
std::optional<RunVerdict> run_once(const Scenario& scenario, const std::string& name, const std::filesystem::path& data_root,
                                  const std::filesystem::path& root, RunObserver& observer);

}  // namespace patrol::app
