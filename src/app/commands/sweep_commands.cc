#include <utility>

#include <fmt/format.h>

#include "app/campaign/sweep/finish_sweep.h"
#include "app/campaign/sweep/plan.h"
#include "app/campaign/sweep/run_sweep.h"
#include "app/campaign/sweep/slurm_engine.h"
#include "app/commands/commands.h"
#include "core/error.h"

namespace patrol::app {
namespace {

/// Checks options that have no check of their own. Throws InputError.
void check(const SweepOptions& options) {
  if (options.engine != "local" && options.engine != "slurm")
    throw InputError(fmt::format("--engine {}: must be local or slurm", options.engine));
  if (options.early_stop && (!options.shard.empty() || options.engine == "slurm")) {
    throw InputError("--early-stop: not compatible with --shard and --engine slurm: decisions depend on all results");
  }
  if (options.engine == "slurm" && !options.shard.empty())
    throw InputError("--shard: not compatible with --engine slurm, which has --slurm-tasks");
  for (const auto& [option, is_given] :
       {std::pair{"--detach", options.detach}, std::pair{"--slurm-option", !options.slurm_options.empty()},
        std::pair{"--slurm-tasks", options.slurm_tasks != SweepOptions{}.slurm_tasks}}) {
    if (is_given && options.engine != "slurm") throw InputError(fmt::format("{}: needs --engine slurm", option));
  }
  if (options.metrics.empty()) throw InputError("--metric: at least one is required");
  if (!(options.equivalence_margin >= 0.0)) throw InputError("--equivalence-margin: must not be negative");
  if (options.equivalence_margin > 0.0 && !options.early_stop)
    throw InputError("--equivalence-margin: needs --early-stop");
  if (options.slurm_tasks < 1 || options.slurm_tasks > 100'000)
    throw InputError("--slurm-tasks: must be in [1, 100000]");
}

ExitCode perform(const std::filesystem::path& scenario, const SweepManifest& manifest, const Shard& shard,
                 const BatchSettings& settings, const std::filesystem::path& out, ResultForm form) {
  check_sweep(scenario, manifest, settings);
  const SweepDirectory directory = begin_sweep_directory(out, manifest);
  run_sweep(scenario, manifest, directory, shard, settings);
  return finish_sweep(directory, manifest, form, shard);
}

}  // namespace

ExitCode sweep_command(const SweepOptions& options) {
  check(options);
  const Shard shard = parse_shard(options.shard);
  const BatchSettings settings = batch_settings(options.batch);
  const SweepManifest manifest = plan_sweep(options);
  if (options.engine == "slurm") return sweep_on_slurm(options, begin_sweep_directory(options.out, manifest), manifest);
  return perform(options.scenario, manifest, shard, settings, options.out, options.form);
}

ExitCode error_budget_command(const ErrorBudgetOptions& options) {
  const BatchSettings settings = batch_settings(options.batch);
  return perform(options.scenario, plan_error_budget(options), {}, settings, options.out, options.form);
}

ExitCode fault_matrix_command(const FaultMatrixOptions& options) {
  const BatchSettings settings = batch_settings(options.batch);
  return perform(options.scenario, plan_fault_matrix(options), {}, settings, options.out, options.form);
}

}  // namespace patrol::app
