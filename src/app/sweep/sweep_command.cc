#include <fmt/format.h>

#include "app/commands.h"
#include "app/sweep/finish_sweep.h"
#include "app/sweep/run_sweep.h"
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

}  // namespace

ExitCode sweep_command(const SweepOptions& options) {
  check(options);
  const Shard shard = parse_shard(options.shard);
  parse_keep(options.keep);
  parse_jobs(options.jobs);
  const SweepManifest manifest = plan_sweep(options);
  const SweepDirectory directory = begin_sweep_directory(options.out, manifest);
  if (options.engine == "slurm") return sweep_on_slurm(options, directory, manifest);

  const BatchSettings settings{.pool = {.num_processes = parse_jobs(options.jobs), .limit_s = options.run_limit_s},
                               .keep = parse_keep(options.keep)};
  if (!run_sweep(options.scenario, manifest, directory, shard, settings)) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete, the same command goes on\n", directory.root.string());
    return ExitCode::kProgramFailed;
  }
  return finish_sweep(directory, manifest);
}

}  // namespace patrol::app
