#pragma once

#include "app/campaign/sweep/sweep_directory.h"
#include "app/campaign/sweep/sweep_options.h"
#include "app/common/exit_code.h"
#include "app/common/print_result.h"

namespace patrol::app {

/// Completes a sweep with all results: writes the tables, prints the comparison, and returns the exit code of the worst
/// run. Otherwise prints the number of missing runs, and returns the exit code of the worst run of the shard if it
/// failed or had invalid input, else kDone.
ExitCode finish_sweep(const SweepDirectory& directory, const SweepManifest& manifest, ResultForm form,
                      const Shard& shard = {});

}  // namespace patrol::app
