#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/batch/result_store.h"
#include "app/sweep/manifest.h"
#include "io/table.h"

namespace patrol::app {

/// The files of a sweep, an error budget or a fault matrix: sweep.json (what was asked), runs/ (results by address), and once all are there
/// a CSV file of each table and sweep.sqlite with all of them; until then INCOMPLETE.
struct SweepDirectory {
  std::filesystem::path root;

  std::filesystem::path manifest() const { return root / "sweep.json"; }
  std::filesystem::path table(const std::string& name) const { return root / (name + ".csv"); }
  std::filesystem::path sqlite() const { return root / "sweep.sqlite"; }
  ResultStore store() const { return ResultStore(runs_folder(root)); }
};

/// Makes the directory, marks it incomplete (output_directory.h), and writes down what is asked; results that lie there stay, so that to go
/// on is to skip them.
SweepDirectory begin_sweep_directory(const std::filesystem::path& root, const SweepManifest& manifest);

/// Throws InputError when there is none.
SweepDirectory open_sweep_directory(const std::filesystem::path& root);

/// Writes the tables: the same tables give the same bytes. Takes the mark away.
void complete_sweep_directory(const SweepDirectory& directory, const std::vector<io::Table>& tables);

}  // namespace patrol::app
