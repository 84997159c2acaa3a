#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/frames.h"

namespace patrol::io {

using Json = nlohmann::json;

/// Throws InputError, naming the file and the place, when it is not JSON, says a key twice, or has a list of more than `max_entries`.
Json load_json(const std::filesystem::path& file, std::size_t max_entries = 100'000);

/// Reads the members of one JSON object and knows where it stands: whatever is missing, unknown or of the wrong kind is refused
/// with an InputError that names the place ("site.json: stations[2]") and the key.
class JsonObject {
 public:
  /// `json` must outlive this; `keys` are all that it may hold.
  JsonObject(std::string place, const Json& json, const std::vector<std::string>& keys);

  bool has(const char* key) const { return json_.contains(key); }
  const Json& member(const char* key) const;
  const Json& list(const char* key) const;
  int whole(const char* key) const;
  double number(const char* key) const;  ///< finite
  std::string word(const char* key) const;  ///< without control characters (C0, DEL, C1)
  bool flag(const char* key) const;
  std::vector<double> numbers(const char* key, std::size_t count) const;
  /// From `position` (x, y, z) and `orientation` (quaternion x, y, z, w of length 1, upright).
  Pose2 pose() const;
  /// At least two points [x, y].
  std::vector<Eigen::Vector2d> polyline(const char* key) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::vector<double> numbers_of(const Json& json, const std::string& what, std::size_t count) const;

  std::string place_;
  const Json& json_;
};

}  // namespace patrol::io
