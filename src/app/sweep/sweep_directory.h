#pragma once

#include <filesystem>

#include "app/exit_code.h"
#include "app/sweep/comparison.h"
#include "app/sweep/manifest.h"

namespace patrol::app {

/// The files of a sweep: sweep.json (what was asked), runs/ (results by address), and once all are there runs.csv, comparison.csv and
/// sweep.sqlite; until then INCOMPLETE.
struct SweepDirectory {
  std::filesystem::path root;

  std::filesystem::path manifest() const { return root / "sweep.json"; }
  std::filesystem::path runs() const { return root / "runs"; }
  std::filesystem::path runs_csv() const { return root / "runs.csv"; }
  std::filesystem::path comparison_csv() const { return root / "comparison.csv"; }
  std::filesystem::path sqlite() const { return root / "sweep.sqlite"; }
  std::filesystem::path budget_csv() const { return root / "budget.csv"; }  ///< of an error budget
  std::filesystem::path incomplete_marker() const { return root / "INCOMPLETE"; }
  ResultStore store() const { return ResultStore(runs()); }
};

/// Makes the directory, marks it incomplete, and writes down what is asked; results that lie there stay, so that to go on is to skip
/// them. Throws InputError when it holds anything that is not a sweep's, or cannot be written.
SweepDirectory begin_sweep_directory(const std::filesystem::path& root, const SweepManifest& manifest);

/// Tables from whatever made the rows: the same rows give the same bytes. Takes the mark away.
void complete_sweep_directory(const SweepDirectory& directory, const SweepManifest& manifest, const SweepRows& rows,
                              const SweepProgress& progress);

/// Of the runs that count; 5 when there are none.
ExitCode worst_of(const SweepRows& rows, const SweepProgress& progress);

}  // namespace patrol::app
