#pragma once

#include "app/campaign/sweep/manifest.h"
#include "app/campaign/sweep/sweep_options.h"

namespace patrol::app {

/// Plans a sweep, with the content hash of every run. Loads the scenario of every variant: an invalid key or value is
/// reported before anything runs. These functions throw InputError.
SweepManifest plan_sweep(const SweepOptions& options);

/// Plans an error budget: the unchanged scenario (baseline), without each of its error sources (error_sources.h), and
/// without all.
SweepManifest plan_error_budget(const ErrorBudgetOptions& options);

/// Plans a fault matrix: the unchanged scenario, and with each fault of its sensors (fault_matrix.h).
SweepManifest plan_fault_matrix(const FaultMatrixOptions& options);

}  // namespace patrol::app
