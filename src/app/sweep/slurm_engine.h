#pragma once

#include <string>
#include <vector>

#include "app/exit_code.h"
#include "app/sweep/sweep_directory.h"
#include "app/sweep/sweep_options.h"

namespace patrol::app {

/// Runs a sweep on a Slurm cluster whose nodes see its directory: one job array, each task a shard of many runs. Waits, submits the shards
/// that left runs undone once or twice more, and writes the tables; with `detach`, submits and returns. The same call later finds the
/// job again (slurm/job), waits for it or submits what is missing.
ExitCode sweep_on_slurm(const SweepOptions& options, const SweepDirectory& directory, const SweepManifest& manifest);

/// The command of one shard, with `shard` as the shell reads it.
std::string shard_command(const SweepOptions& options, const std::filesystem::path& program, const std::string& shard);

/// Shards, from 1, that have something to do: "1,3,4".
std::string shards_with_work(const std::vector<std::size_t>& needed, int num_shards);

}  // namespace patrol::app
