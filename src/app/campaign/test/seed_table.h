#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace patrol::app {

/// Seeds of scenarios in `patrol test`, in place of those of their files: a JSON object such as
/// {"street/scenarios/patrol.yaml": 3}. A key is the end of a scenario's path, whole names only.
class SeedTable {
 public:
  SeedTable() = default;
  /// Throws InputError if the file is missing or invalid.
  explicit SeedTable(const std::filesystem::path& file);

  /// Seed of a scenario; none if the table does not have it. The longest key that matches counts.
  std::optional<std::uint64_t> seed_of(const std::filesystem::path& scenario) const;

  /// Whether the table has no seeds.
  bool is_empty() const { return rows_.empty(); }

 private:
  struct Row {
    std::string key;
    std::uint64_t seed = 1;
  };
  std::vector<Row> rows_;
};

}  // namespace patrol::app
