#include "app/campaign/sweep/sweep_directory.h"

#include <fmt/format.h>

#include "app/common/output_directory.h"
#include "core/error.h"
#include "io/files/csv.h"
#include "io/files/sqlite.h"

namespace patrol::app {
namespace {

// Several processes may share one directory: files being written by another one (*.part) stay.
const OutputKind kSweep = {
    .name = "sweep",
    .marker_text = "Incomplete sweep: repeat the command to continue.",
    .outputs = {"runs.csv", "comparison.csv", "budget.csv", "faults.csv", "faults.md", "sweep.sqlite", "report.html"},
    .required_file = "sweep.json",
    .preserved = {"sweep.json", "runs", "work", "slurm", "*.part"},
    .is_concurrent = true};

}  // namespace

SweepDirectory begin_sweep_directory(const std::filesystem::path& root, const SweepManifest& manifest) {
  const OutputLock shared = begin_output(root, kSweep);
  SweepDirectory directory{root};
  save_manifest(directory.manifest(), manifest);
  return directory;
}

SweepDirectory open_sweep_directory(const std::filesystem::path& root) {
  SweepDirectory directory{root};
  if (!std::filesystem::exists(directory.manifest()))
    throw InputError(fmt::format("{}: not a sweep directory: sweep.json not found", root.string()));
  return directory;
}

void complete_sweep_directory(const SweepDirectory& directory, const std::vector<io::Table>& tables) {
  for (const io::Table& table : tables) io::save_csv(directory.table(table.name), table);
  io::save_sqlite(directory.sqlite(), tables);
  complete_output(directory.root);
}

}  // namespace patrol::app
