#pragma once

#include <string>
#include <vector>

#include "app/campaign/sweep/sweep_directory.h"
#include "app/campaign/sweep/sweep_options.h"
#include "app/common/exit_code.h"

namespace patrol::app {

/// Runs a sweep on a Slurm cluster whose nodes share its directory: one job array, each task a shard of the runs.
/// Waits, resubmits shards with missing runs, at most twice, and writes the tables. With `detach`, submits and returns.
/// A repeated call finds the job again (slurm/job), waits for it or submits missing shards.
ExitCode sweep_on_slurm(const SweepOptions& options, const SweepDirectory& directory, const SweepManifest& manifest);

/// Command line of one shard, with `shard` in shell syntax.
std::string shard_command(const SweepOptions& options, const std::filesystem::path& program, const std::string& shard);

/// List of the shards, from 1, with missing runs: "1,3,4".
std::string shards_with_work(const std::vector<std::size_t>& needed, int num_shards);

}  // namespace patrol::app
