#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/sweep/manifest.h"
#include "app/batch/run_batch.h"

namespace patrol::app {

/// The call of `patrol sweep`.
struct SweepOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;  ///< "path=value", common to all
  std::vector<std::string> vary;       ///< axis.h
  std::string seeds = "10";            ///< "N": 1 ... N; or "A..B"
  std::vector<std::string> metrics = {"pose.ate_rmse_m", "pose.heading_rmse_deg", "map.nearest_mean_m", "mission.completed"};
  bool stop_when_decided = false;
  double margin = 0.0;
  int jobs = 0;                        ///< runs at a time; 0: one for each core
  std::string shard;                   ///< "i/n", or all
  std::string engine = "local";
  std::string keep = "none";
  double run_limit_s = 3600.0;         ///< wall time of a run
  int slurm_tasks = 8;                 ///< of the array; each takes a shard
  std::vector<std::string> slurm_options;  ///< for sbatch, "--partition=long"
  bool detach = false;                 ///< submit, and do not wait
  std::filesystem::path out = "out/sweep";
};

/// The call of `patrol budget`.
struct BudgetOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  std::string seeds = "5";
  std::vector<std::string> metrics = {"pose.ate_rmse_m", "map.nearest_mean_m"};
  int jobs = 0;
  double run_limit_s = 3600.0;
  std::filesystem::path out = "out/budget";
};

/// A part of the runs: those whose number leaves `index` when divided by `count`.
struct Shard {
  std::size_t index = 0;  ///< from 0
  std::size_t count = 1;

  bool holds(std::size_t run) const { return run % count == index; }
};

/// These throw InputError, naming the option.
std::vector<std::uint64_t> parse_seeds(const std::string& text);
Shard parse_shard(const std::string& text);
KeepRuns parse_keep(const std::string& text);
/// The number of cores for 0.
int parse_jobs(int jobs);

/// What is asked for, with every run's address. Every variant's scenario is read: a wrong key or value is found before anything runs.
SweepManifest plan_sweep(const SweepOptions& options);

}  // namespace patrol::app
