#include <algorithm>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/sweep/finish_sweep.h"
#include "app/sweep/slurm_engine.h"
#include "app/sweep/sweep_directory.h"
#include "core/error.h"

namespace patrol::app {
namespace {

/// What stands in the way of a sweep that its parts do not say themselves.
void check(const SweepOptions& options) {
  if (options.engine != "local" && options.engine != "slurm") throw InputError(fmt::format("--engine {}: must be local or slurm", options.engine));
  if (options.stop_when_decided && (!options.shard.empty() || options.engine == "slurm")) {
    throw InputError("--stop-when-decided: cannot be shared out, since what is still to do depends on what all have found");
  }
  if (options.engine == "slurm" && !options.shard.empty()) throw InputError("--shard: the engine slurm makes the shards itself (--slurm-tasks)");
  if (options.metrics.empty()) throw InputError("--metric: at least one is compared");
  if (!(options.run_limit_s > 0.0)) throw InputError("--run-limit-s: must be greater than 0");
  if (!(options.margin >= 0.0)) throw InputError("--margin: must not be negative");
  if (options.slurm_tasks < 1 || options.slurm_tasks > 100'000) throw InputError("--slurm-tasks: must lie in 1 ... 100000");
}

/// Runs what of `needed` is in the shard. False when interrupted.
bool run_here(const SweepOptions& options, const SweepDirectory& directory, const SweepManifest& manifest, const std::vector<std::size_t>& mine) {
  std::vector<BatchRun> runs;
  for (const std::size_t i : mine) {
    const PlannedRun& run = manifest.runs[i];
    runs.push_back({.scenario = options.scenario,
                    .overrides = overrides_of(manifest, run),
                    .address = run.address,
                    .label = fmt::format("{}, seed {}", manifest.variants[run.variant].name, run.seed)});
  }
  const BatchSettings settings{.pool = {.num_processes = parse_jobs(options.jobs), .limit_s = options.run_limit_s},
                               .keep = parse_keep(options.keep)};
  return run_batch(runs, settings, directory.root);
}

}  // namespace

ExitCode sweep_command(const SweepOptions& options) {
  check(options);
  const Shard shard = parse_shard(options.shard);
  parse_keep(options.keep);
  parse_jobs(options.jobs);
  const SweepManifest manifest = plan_sweep(options);
  const SweepDirectory directory = begin_sweep_directory(options.out, manifest);
  if (options.engine == "slurm") return sweep_on_slurm(options, directory, manifest);

  while (true) {
    const SweepProgress progress = progress_of(manifest, load_rows(manifest, directory.store()));
    std::vector<std::size_t> mine;
    std::copy_if(progress.needed.begin(), progress.needed.end(), std::back_inserter(mine), [&](std::size_t i) { return shard.holds(i); });
    if (mine.empty()) return finish_sweep(directory, manifest);
    if (!run_here(options, directory, manifest, mine)) {
      fmt::print(stderr, "patrol: interrupted; {} is incomplete, the same command goes on\n", directory.root.string());
      return ExitCode::kProgramFailed;
    }
  }
}

}  // namespace patrol::app
