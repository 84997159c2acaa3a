#pragma once

#include "app/sweep/manifest.h"
#include "app/sweep/sweep_options.h"

namespace patrol::app {

/// What is asked for, with every run's address. Every variant's scenario is read: a wrong key or value is found before anything runs.
/// These throw InputError.
SweepManifest plan_sweep(const SweepOptions& options);

/// The scenario as it is, without each imperfection that it has (imperfections.h), and without all.
SweepManifest plan_budget(const BudgetOptions& options);

/// The scenario as it is, and with each fault that its sensors can have (fault_matrix.h).
SweepManifest plan_faults(const FaultsOptions& options);

}  // namespace patrol::app
