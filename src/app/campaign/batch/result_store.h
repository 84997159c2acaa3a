#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/run/run_verdict.h"

namespace patrol::app {

/// Folder `root/runs` of the results and the kept run directories.
inline std::filesystem::path runs_folder(const std::filesystem::path& root) { return root / "runs"; }

/// Store of results by content hash or name, one file `KEY.json` each, written atomically.
class ResultStore {
 public:
  explicit ResultStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  bool has(const std::string& key) const { return std::filesystem::exists(file(key)); }
  /// Result of a key; none if missing. Throws InputError if the file is damaged.
  std::optional<RunVerdict> load(const std::string& key) const;
  void save(const std::string& key, const RunVerdict& verdict) const;
  /// Removes the result of a key if a stack in another process failed or was silent: a repetition may succeed.
  void remove_stack_failure(const std::string& key) const;
  /// Copies a result from another store; it may exist in both.
  void copy(const std::string& key, const ResultStore& from) const;

 private:
  std::filesystem::path file(const std::string& key) const { return folder_ / (key + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace patrol::app
