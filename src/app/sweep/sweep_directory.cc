#include "app/sweep/sweep_directory.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "app/sweep/sweep_tables.h"
#include "core/error.h"
#include "io/csv.h"
#include "io/sqlite.h"

namespace patrol::app {
namespace {

constexpr std::array<std::string_view, 10> kOurFiles = {"sweep.json", "runs", "work", "runs.csv", "comparison.csv",
                                                        "sweep.sqlite", "INCOMPLETE", "report.html", "slurm", "budget.csv"};

void refuse_foreign(const std::filesystem::path& root) {
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (std::find(kOurFiles.begin(), kOurFiles.end(), name) == kOurFiles.end() && !name.ends_with(".part")) {
      throw InputError(fmt::format("{}: holds {}, which is not part of a sweep; name an empty or new directory", root.string(), name));
    }
  }
}

}  // namespace

SweepDirectory begin_sweep_directory(const std::filesystem::path& root, const SweepManifest& manifest) {
  const SweepDirectory directory{root};
  std::error_code error;
  std::filesystem::create_directories(directory.runs(), error);
  if (error) throw InputError(fmt::format("{}: cannot be made a directory: {}", root.string(), error.message()));
  refuse_foreign(root);
  std::ofstream marker(directory.incomplete_marker());
  marker << "Not every run of this sweep has ended: tables come at the end. The same command goes on.\n";
  if (!marker.flush()) throw InputError(fmt::format("{}: cannot be written to", root.string()));
  for (const auto& table : {directory.runs_csv(), directory.comparison_csv(), directory.sqlite(), directory.budget_csv()}) std::filesystem::remove(table, error);
  save_manifest(directory.manifest(), manifest);
  return directory;
}

void complete_sweep_directory(const SweepDirectory& directory, const SweepManifest& manifest, const SweepRows& rows,
                              const SweepProgress& progress) {
  const io::Table runs = runs_table(manifest, rows, progress);
  const io::Table comparison = comparison_table(manifest, rows, progress);
  io::save_csv(directory.runs_csv(), runs);
  io::save_csv(directory.comparison_csv(), comparison);
  io::save_sqlite(directory.sqlite(), {runs, comparison});
  std::filesystem::remove(directory.incomplete_marker());
}

ExitCode worst_of(const SweepRows& rows, const SweepProgress& progress) {
  if (progress.counted.empty()) return ExitCode::kNothingExecuted;
  ExitCode worst = ExitCode::kDone;
  for (const std::size_t i : progress.counted) worst = worse(worst, rows[i]->code);
  return worst;
}

}  // namespace patrol::app
