#pragma once

#include "app/exit_code.h"
#include "app/sweep/sweep_directory.h"

namespace patrol::app {

/// Once all its results are there: writes the tables, prints the comparison, and gives the worst run's code. Before: says how many runs
/// are missing.
ExitCode finish_sweep(const SweepDirectory& directory, const SweepManifest& manifest);

}  // namespace patrol::app
