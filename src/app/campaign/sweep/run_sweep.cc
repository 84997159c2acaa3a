#include "app/campaign/sweep/run_sweep.h"

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/campaign/sweep/comparison.h"

namespace patrol::app {
namespace {

BatchRun batch_run(const std::filesystem::path& scenario, const SweepManifest& manifest, const PlannedRun& run) {
  return {.scenario = scenario,
          .overrides = overrides_of(manifest, run),
          .key = run.hash,
          .label = fmt::format("{}, seed {}", manifest.variants[run.variant].name, run.seed)};
}

}  // namespace

void check_sweep(const std::filesystem::path& scenario, const SweepManifest& manifest, const BatchSettings& settings) {
  std::vector<BatchRun> runs;
  for (const PlannedRun& run : manifest.runs) runs.push_back(batch_run(scenario, manifest, run));
  require_own_stacks(runs, settings);
}

void run_sweep(const std::filesystem::path& scenario, const SweepManifest& manifest, const SweepDirectory& directory,
               const Shard& shard, const BatchSettings& settings) {
  for (std::size_t i = 0; i < manifest.runs.size(); ++i) {
    if (shard.contains(i)) directory.store().remove_stack_failure(manifest.runs[i].hash);
  }
  while (true) {
    const SweepProgress progress = evaluate_progress(manifest, load_rows(manifest, directory.store()));
    std::vector<BatchRun> runs;
    std::set<std::string> requested;  // variants with equal settings have one result
    for (const std::size_t i : progress.needed) {
      const PlannedRun& run = manifest.runs[i];
      if (!shard.contains(i) || !requested.insert(run.hash).second) continue;
      runs.push_back(batch_run(scenario, manifest, run));
    }
    if (runs.empty()) return;
    if (!run_batch(runs, settings, directory.root)) {
      throw std::runtime_error(
          fmt::format("interrupted; {} is incomplete, repeat the command to continue", directory.root.string()));
    }
  }
}

}  // namespace patrol::app
