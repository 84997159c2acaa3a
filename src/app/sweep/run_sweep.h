#pragma once

#include <filesystem>

#include "app/batch/run_batch.h"
#include "app/sweep/sweep_directory.h"
#include "app/sweep/sweep_options.h"

namespace patrol::app {

/// Does what of a sweep is in the shard and has no result yet, on this machine; with early stopping, look by look. Throws std::runtime_error when interrupted.
void run_sweep(const std::filesystem::path& scenario, const SweepManifest& manifest, const SweepDirectory& directory, const Shard& shard,
               const BatchSettings& settings);

}  // namespace patrol::app
