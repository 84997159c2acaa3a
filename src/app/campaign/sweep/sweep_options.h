#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/campaign/batch/batch_options.h"
#include "app/common/print_result.h"

namespace patrol::app {

/// Options of `patrol sweep`.
struct SweepOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;  ///< "path=value", for all runs
  std::vector<std::string> vary;       ///< axis.h
  std::string seeds = "10";            ///< "N": 1 ... N; or "A..B"
  std::vector<std::string> metrics = {"pose.ate_rmse_m", "pose.heading_rmse_deg", "map.nearest_mean_m",
                                      "mission.completed"};
  bool early_stop = false;
  double equivalence_margin = 0.0;
  BatchOptions batch;
  std::string shard;  ///< "i/n"; empty: all
  std::string engine = "local";
  int slurm_tasks = 8;                     ///< tasks of the job array; each runs a shard
  std::vector<std::string> slurm_options;  ///< options for sbatch, "--partition=long"
  bool detach = false;                     ///< submit without waiting
  std::filesystem::path out = "out/sweep";
  ResultForm form = ResultForm::kText;
};

/// Options of `patrol error-budget`.
struct ErrorBudgetOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  std::string seeds = "5";
  std::vector<std::string> metrics = {"pose.ate_rmse_m", "map.nearest_mean_m"};
  BatchOptions batch;
  std::filesystem::path out = "out/budget";
  ResultForm form = ResultForm::kText;
};

/// Options of `patrol fault-matrix`.
struct FaultMatrixOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  std::string seeds = "3";
  std::vector<std::string> metrics = {"pose.ate_max_m", "pose.ate_rmse_m", "pose.heading_rmse_deg", "map.coverage",
                                      "map.nearest_mean_m"};
  std::vector<std::string> faults;  ///< names of the faults to run, "lidar: dropout"; empty: all
  double start_s = 12.0;            ///< start of every fault
  double duration_s = 8.0;
  double max_error_m = 0.3;       ///< `pose.ate_max_m` that a survived run may have
  double min_map_coverage = 0.5;  ///< `map.coverage` that a survived run must have
  double max_lost_s = 10.0;       ///< `localization.lost_s` that a survived run on a given map may have
  BatchOptions batch;
  std::filesystem::path out = "out/faults";
  ResultForm form = ResultForm::kText;
};

/// Part of the runs: those whose number modulo `count` is `index`.
struct Shard {
  std::size_t index = 0;  ///< from 0
  std::size_t count = 1;

  bool contains(std::size_t run) const { return run % count == index; }
};

/// Parses the seeds "N" or "A..B". Throws InputError with the option's name.
std::vector<std::uint64_t> parse_seeds(const std::string& text, const std::string& option = "--seeds");
/// Parses a shard "i/n". Throws InputError with the option's name.
Shard parse_shard(const std::string& text);

}  // namespace patrol::app
