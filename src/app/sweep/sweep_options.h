#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/batch/batch_options.h"

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
  BatchOptions batch;
  std::string shard;                   ///< "i/n", or all
  std::string engine = "local";
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
  BatchOptions batch;
  std::filesystem::path out = "out/budget";
};

/// The call of `patrol faults`.
struct FaultsOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  std::string seeds = "1";
  std::vector<std::string> metrics = {"pose.ate_rmse_m", "pose.heading_rmse_deg", "map.nearest_mean_m"};
  double start_s = 12.0;     ///< of every fault
  double duration_s = 8.0;
  BatchOptions batch;
  std::filesystem::path out = "out/faults";
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

}  // namespace patrol::app
