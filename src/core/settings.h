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

/// Conventions for settings. Settings are plain structs with default member values. Each struct lists its fields once,
/// in a static function; this list serves reading from YAML, writing with all defaults, and validation
/// (io/yaml/settings_yaml.h):
///
///   struct LidarSettings {
///     double range_noise_std_m = 0.03;   ///< standard deviation
///     std::string preset = "rplidar_s2";
///     template <typename Self, typename Visitor>
///     static void fields(Self& self, Visitor& visit) {
///       visit("range_noise_std_m", self.range_noise_std_m, at_least(0.0));
///       visit("preset", self.preset, one_of({"rplidar_s2", "utm30lx"}));
///     }
///   };
///
/// Field types: bool, int, std::uint64_t, double, std::string, std::vector<double>, std::vector<std::string>, other
/// settings structs, and std::vector of settings structs. Names contain the unit.
namespace patrol {

/// Admissible values of a field. Numbers: closed interval. Strings: one of `allowed`, or any if that is empty.
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

/// Returns the rule as text for error messages.
inline std::string describe_limits(const Limits& limits) {
  if (!limits.allowed.empty()) return fmt::format("must be one of {}", fmt::join(limits.allowed, ", "));
  const bool has_min = std::isfinite(limits.min), has_max = std::isfinite(limits.max);
  if (has_min && has_max) return fmt::format("must be in [{}, {}]", limits.min, limits.max);
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

/// Checks one field; used through `validate`.
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
    throw InputError(fmt::format("{} = {}: {}", key, value, describe_limits(limits)));
  }

  std::string prefix_;
};

/// Throws InputError "<prefix>.<field> = <value>: <rule>" for the first invalid field.
template <typename Settings>
void validate(const Settings& settings, const std::string& prefix = "") {
  Validator validator(prefix);
  Settings::fields(settings, validator);
}

}  // namespace patrol
