#include <fmt/format.h>

#include "app/campaign/sweep/comparison.h"
#include "app/campaign/sweep/finish_sweep.h"
#include "app/commands/commands.h"
#include "core/error.h"
#include "io/files/atomic_file.h"

namespace patrol::app {
namespace {

std::string load_request(const SweepDirectory& directory) {
  return io::load_text(open_sweep_directory(directory.root).manifest());
}

}  // namespace

ExitCode merge_command(const MergeOptions& options) {
  const auto& [root, parts, form] = options;
  std::vector<SweepDirectory> sources;
  for (const std::filesystem::path& part : parts) sources.push_back({part});
  const bool is_new = !std::filesystem::exists(SweepDirectory{root}.manifest()) && !parts.empty();
  const SweepDirectory first = open_sweep_directory(is_new ? parts.front() : root);
  const SweepManifest manifest = load_manifest(first.manifest());
  for (const SweepDirectory& source : sources) {
    if (load_request(source) == load_request(first)) continue;
    throw InputError(fmt::format("{}: is not a shard of {}", source.manifest().string(), first.manifest().string()));
  }

  const SweepDirectory directory = begin_sweep_directory(root, manifest);
  for (const SweepDirectory& source : sources) {
    for (const PlannedRun& run : manifest.runs) {
      if (source.store().has(run.hash)) directory.store().copy(run.hash, source.store());
    }
  }
  const SweepProgress progress = evaluate_progress(manifest, load_rows(manifest, directory.store()));
  if (!progress.needed.empty()) {
    throw InputError(
        fmt::format("{}: {} of {} runs are missing", root.string(), progress.needed.size(), progress.counted.size()));
  }
  return finish_sweep(directory, manifest, form);
}

}  // namespace patrol::app
