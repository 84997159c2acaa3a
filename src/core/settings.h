#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/named_table.h"

/// Settings are plain structs with their defaults in place. Each lists its fields once, in a static function, and from
/// that list they are read from YAML, written out with every default, and checked (io/settings_yaml.h):
///
///   struct LidarSettings {
///     double range_noise_m = 0.03;   ///< standard deviation
///     std::string preset = "rplidar_s2";
///     template <typename Self, typename Visitor>
///     static void fields(Self& self, Visitor& visit) {
///       visit("range_noise_m", self.range_noise_m, at_least(0.0));
///       visit("preset", self.preset, one_of({"rplidar_s2", "utm30lx"}));
///     }
///   };
///
/// Field types: bool, int, std::uint64_t, double, std::string, std::vector<double>, std::vector<std::string>, another
/// settings struct, and std::vector of settings structs. Names carry their unit.
namespace patrol {

/// What a field may be. Numbers: closed interval; strings: one of `allowed` unless that is empty.
struct Limits {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> allowed;
};

inline Limits any() { return {}; }
inline Limits at_least(double min) { return {.min = min, .allowed = {}}; }
inline Limits between(double min, double max) { return {.min = min, .max = max, .allowed = {}}; }
inline Limits one_of(std::vector<std::string> allowed) {
  Limits limits;
  limits.allowed = std::move(allowed);
  return limits;
}

/// The names of a table of enumerators or factories.
template <NamedTable Table>
Limits one_of(const Table& table) {
  Limits limits;
  limits.allowed = names_of(table);
  return limits;
}

/// The rule as a person would say it; empty if there is none.
inline std::string rule_of(const Limits& limits) {
  if (!limits.allowed.empty()) return fmt::format("must be one of {}", fmt::join(limits.allowed, ", "));
  const bool has_min = std::isfinite(limits.min), has_max = std::isfinite(limits.max);
  if (has_min && has_max) return fmt::format("must lie in {} ... {}", limits.min, limits.max);
  if (has_min) return fmt::format("must be at least {}", limits.min);
  if (has_max) return fmt::format("must be at most {}", limits.max);
  return "must be finite";
}

inline bool allows(const Limits& limits, double value) {
  return std::isfinite(value) && value >= limits.min && value <= limits.max;
}

inline bool allows(const Limits& limits, const std::string& value) {
  if (limits.allowed.empty()) return true;
  for (const std::string& allowed : limits.allowed) {
    if (value == allowed) return true;
  }
  return false;
}

/// Checks one field; for use through `validate`.
class Validator {
 public:
  explicit Validator(std::string prefix) : prefix_(std::move(prefix)) {}

  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& limits = {}) {
    const std::string key = prefix_.empty() ? name : prefix_ + "." + name;
    if constexpr (std::is_same_v<Value, bool>) {
      return;
    } else if constexpr (std::is_arithmetic_v<Value>) {
      if (!allows(limits, static_cast<double>(value))) fail(key, fmt::format("{}", value), limits);
    } else if constexpr (std::is_same_v<Value, std::string>) {
      if (!allows(limits, value)) fail(key, value, limits);
    } else if constexpr (requires { value.begin(); }) {
      int index = 0;
      Validator elements(key);
      for (const auto& element : value) elements(fmt::format("{}", index++).c_str(), element, limits);
    } else {
      Validator nested(key);
      Value::fields(value, nested);
    }
  }

 private:
  [[noreturn]] static void fail(const std::string& key, const std::string& value, const Limits& limits) {
    throw InputError(fmt::format("{} = {}: {}", key, value, rule_of(limits)));
  }

  std::string prefix_;
};

/// Throws InputError "<prefix>.<field> = <value>: <rule>" for the first field that breaks its rule.
template <typename Settings>
void validate(const Settings& settings, const std::string& prefix = "") {
  Validator validator(prefix);
  Settings::fields(settings, validator);
}

}  // namespace patrol
