#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/run/run_verdict.h"

namespace patrol::app {

/// Folder `root/runs` of the results and the kept run directories.
inline std::filesystem::path runs_folder(const std::filesystem::path& root) { return root / "runs"; }

/// Store of results by content hash of the request, one file `ADDRESS.json` each, written atomically.
class ResultStore {
 public:
  explicit ResultStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  bool has(const std::string& address) const { return std::filesystem::exists(file(address)); }
  /// Result of an address; none if missing. Throws InputError if the file is damaged.
  std::optional<RunVerdict> load(const std::string& address) const;
  void save(const std::string& address, const RunVerdict& verdict) const;
  /// Copies a result from another store; it may exist in both.
  void copy(const std::string& address, const ResultStore& from) const;

 private:
  std::filesystem::path file(const std::string& address) const { return folder_ / (address + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace patrol::app
