#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace patrol::app {

/// Axis of a sweep: one scenario key and its values, `path=...` with
///
///   a,b,c                          a list, of any YAML values
///   range:FROM:TO:N                N values, uniformly spaced from FROM to TO, both ends included
///   logrange:FROM:TO:N             N values with equal ratios from FROM to TO, both ends included
///   uniform:LOW:HIGH               one sample per seed, equal in all variants
///   loguniform:LOW:HIGH
///   normal:MEAN:STANDARD_DEVIATION
struct Axis {
  enum class Kind { kList, kUniform, kLogUniform, kNormal };

  std::string path;
  Kind kind = Kind::kList;
  std::vector<std::string> values;  ///< values of a list or range, as YAML
  double first = 0.0;               ///< parameter of a distribution: LOW or MEAN
  double second = 0.0;              ///< HIGH or STANDARD_DEVIATION

  bool is_random() const { return kind != Kind::kList; }
  /// Override of a random axis for a seed: "path=value".
  std::string sample(std::uint64_t seed) const;
};

/// Parses an axis. Throws InputError with the option's text and the error.
Axis parse_axis(const std::string& text);

/// Variant of the scenario in a sweep.
struct Variant {
  std::string name;                    ///< "path=a, other=b"; "baseline" without overrides
  std::vector<std::string> overrides;  ///< "path=value"
};

/// Cartesian product of the lists' values; the first axis varies slowest. Random axes make no variants. Throws
/// InputError for a duplicate axis.
std::vector<Variant> cartesian_product(const std::vector<Axis>& axes);

}  // namespace patrol::app
