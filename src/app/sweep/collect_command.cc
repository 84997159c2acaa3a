#include <fmt/format.h>

#include "app/commands.h"
#include "app/sweep/finish_sweep.h"
#include "core/error.h"
#include "io/atomic_file.h"

namespace patrol::app {
namespace {

void take_over(const SweepDirectory& directory, const SweepManifest& manifest, const SweepDirectory& from) {
  if (io::load_text(from.manifest()) != io::load_text(directory.manifest())) {
    throw InputError(fmt::format("{}: was asked for something else than {}", from.manifest().string(), directory.manifest().string()));
  }
  for (const PlannedRun& run : manifest.runs) {
    if (from.store().has(run.address)) directory.store().copy(run.address, from.store());
  }
}

}  // namespace

ExitCode collect_command(const std::filesystem::path& root, const std::vector<std::filesystem::path>& parts) {
  SweepDirectory directory{root};
  const bool is_new = !std::filesystem::exists(directory.manifest());
  if (is_new && parts.empty()) throw InputError(fmt::format("{}: not a sweep: it has no sweep.json", root.string()));
  const SweepManifest manifest = load_manifest(is_new ? SweepDirectory{parts.front()}.manifest() : directory.manifest());
  directory = begin_sweep_directory(root, manifest);
  for (const std::filesystem::path& part : parts) take_over(directory, manifest, SweepDirectory{part});
  const SweepProgress progress = progress_of(manifest, load_rows(manifest, directory.store()));
  if (!progress.needed.empty()) {
    throw InputError(fmt::format("{}: {} of {} runs have no result yet; it stays incomplete", root.string(), progress.needed.size(),
                                 progress.counted.size()));
  }
  return finish_sweep(directory, manifest);
}

}  // namespace patrol::app
