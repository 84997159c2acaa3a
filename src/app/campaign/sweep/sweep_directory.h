#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/campaign/batch/result_store.h"
#include "app/campaign/sweep/manifest.h"
#include "io/files/table.h"

namespace patrol::app {

/// Files of a sweep, an error budget or a fault matrix: sweep.json (request) and runs/ (results by content hash). A
/// complete directory also has a CSV file per table and sweep.sqlite with all tables; an incomplete one has INCOMPLETE.
struct SweepDirectory {
  std::filesystem::path root;

  std::filesystem::path manifest() const { return root / "sweep.json"; }
  std::filesystem::path table(const std::string& name) const { return root / (name + ".csv"); }
  std::filesystem::path sqlite() const { return root / "sweep.sqlite"; }
  ResultStore store() const { return ResultStore(runs_folder(root)); }
};

/// Creates the directory, marks it incomplete (output_directory.h), and writes the manifest. Existing results stay, so
/// that an interrupted sweep can be continued.
SweepDirectory begin_sweep_directory(const std::filesystem::path& root, const SweepManifest& manifest);

/// Opens an existing directory. Throws InputError if it is not one.
SweepDirectory open_sweep_directory(const std::filesystem::path& root);

/// Writes the tables, reproducibly to the byte, and removes the marker.
void complete_sweep_directory(const SweepDirectory& directory, const std::vector<io::Table>& tables);

}  // namespace patrol::app
