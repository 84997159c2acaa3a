#pragma once

#include <filesystem>

#include "app/campaign/batch/run_batch.h"
#include "app/campaign/sweep/sweep_directory.h"
#include "app/campaign/sweep/sweep_options.h"

namespace patrol::app {

/// Throws InputError if the runs of a sweep cannot be made at the same time (require_own_stacks).
void check_sweep(const std::filesystem::path& scenario, const SweepManifest& manifest, const BatchSettings& settings);

/// Runs the missing runs of a shard on this machine, and repeats those whose stack in another process failed before.
/// With early stopping, in stages of interim analyses. Throws std::runtime_error if interrupted.
void run_sweep(const std::filesystem::path& scenario, const SweepManifest& manifest, const SweepDirectory& directory,
               const Shard& shard, const BatchSettings& settings);

}  // namespace patrol::app
