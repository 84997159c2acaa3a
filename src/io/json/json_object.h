#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/frames.h"
#include "core/named_table.h"

namespace patrol::io {

using Json = nlohmann::json;

/// Reads a JSON file. Throws InputError with file and JSON path for invalid JSON, duplicate keys, and lists of more
/// than `max_entries` entries.
Json load_json(const std::filesystem::path& file, std::size_t max_entries = 100'000);

/// Checked access to the members of one JSON object. Throws InputError with its path ("site.json: stations[2]") and the
/// key if a member is missing, unknown or of the wrong type.
class JsonObject {
 public:
  /// Creates the accessor. `json` must outlive it; `keys` are the admissible keys.
  JsonObject(std::string place, const Json& json, const std::vector<std::string>& keys);

  bool has(const char* key) const { return json_.contains(key); }
  const Json& member(const char* key) const;
  const Json& list(const char* key) const;
  int integer(const char* key) const;
  double number(const char* key) const;       ///< finite
  std::string string(const char* key) const;  ///< text without control characters (C0, DEL, C1)
  /// Value of the table's row of that name.
  template <NamedTable Table>
  auto choice(const char* key, const Table& table) const {
    const std::string name = string(key);
    if (const auto* row = find_named(table, name)) return row->value;
    fail_choice(key, name, names_of(table));
  }
  bool boolean(const char* key) const;
  std::vector<double> numbers(const char* key, std::size_t count) const;
  /// Returns a pose from `position` (x, y, z) and `orientation` (unit quaternion x, y, z, w, upright).
  Pose2 pose() const;
  /// Returns a polyline of at least two points [x, y].
  std::vector<Eigen::Vector2d> polyline(const char* key) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  [[noreturn]] void fail_choice(const char* key, const std::string& name,
                                const std::vector<std::string>& allowed) const;
  std::vector<double> numbers_of(const Json& json, const std::string& what, std::size_t count) const;

  std::string place_;
  const Json& json_;
};

}  // namespace patrol::io
