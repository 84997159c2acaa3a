#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace patrol::app {

/// What is varied in a sweep: one scenario key and its values, `path=...` with
///
///   a,b,c                          a list, of any YAML values
///   range:FROM:TO:N                N values, evenly from FROM to TO, both ends included
///   logrange:FROM:TO:N             likewise in equal ratios
///   uniform:LOW:HIGH               a draw for each seed, the same in every variant
///   loguniform:LOW:HIGH
///   normal:MEAN:STANDARD_DEVIATION
struct Axis {
  enum class Kind { kList, kUniform, kLogUniform, kNormal };

  std::string path;
  Kind kind = Kind::kList;
  std::vector<std::string> values;  ///< of a list or range, as YAML
  double first = 0.0;               ///< of a distribution: LOW or MEAN
  double second = 0.0;              ///< HIGH or STANDARD_DEVIATION

  bool is_drawn() const { return kind != Kind::kList; }
  /// The override that a drawn axis gives a seed: "path=value".
  std::string draw(std::uint64_t seed) const;
};

/// Throws InputError, naming the option's text and what is wrong with it.
Axis parse_axis(const std::string& text);

/// A way to run the scenario.
struct Variant {
  std::string name;                    ///< "path=a, other=b"; "as it is" where nothing is varied
  std::vector<std::string> overrides;  ///< "path=value"
};

/// Every combination of the lists' values, the first axis slowest. Drawn axes make no variants. Throws InputError when an axis
/// stands there twice.
std::vector<Variant> cross(const std::vector<Axis>& axes);

}  // namespace patrol::app
