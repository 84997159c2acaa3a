#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/run/run_verdict.h"

namespace patrol::app {

/// `root/runs`: results, and the run directories that stay.
inline std::filesystem::path runs_folder(const std::filesystem::path& root) { return root / "runs"; }

/// Results by the address of what was asked: one file each, `ADDRESS.json`, there whole or not at all.
class ResultStore {
 public:
  explicit ResultStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  bool has(const std::string& address) const { return std::filesystem::exists(file(address)); }
  /// Throws InputError when it is damaged.
  std::optional<RunVerdict> load(const std::string& address) const;
  void save(const std::string& address, const RunVerdict& verdict) const;
  /// Takes over a result from another store; that both have it is fine.
  void copy(const std::string& address, const ResultStore& from) const;

 private:
  std::filesystem::path file(const std::string& address) const { return folder_ / (address + ".json"); }

  std::filesystem::path folder_;
};

}  // namespace patrol::app
