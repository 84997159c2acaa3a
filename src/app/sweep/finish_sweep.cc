#include "app/sweep/finish_sweep.h"

#include <fmt/format.h>

#include "app/sweep/sweep_tables.h"

namespace patrol::app {

ExitCode finish_sweep(const SweepDirectory& directory, const SweepManifest& manifest) {
  const SweepRows rows = load_rows(manifest, directory.store());
  const SweepProgress progress = progress_of(manifest, rows);
  if (!progress.needed.empty()) {
    fmt::print("{}: {} of {} runs are still to do; `patrol collect` puts shards together\n", directory.root.string(),
               progress.needed.size(), progress.counted.size());
    return ExitCode::kDone;
  }
  complete_sweep_directory(directory, manifest, rows, progress);
  fmt::print("{}", comparison_text(manifest, rows, progress));
  fmt::print("{} runs: {}\n", progress.counted.size(), directory.runs_csv().string());
  return worst_of(rows, progress);
}

}  // namespace patrol::app
