#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

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

Limits any();
Limits at_least(double min);
Limits between(double min, double max);
Limits one_of(std::vector<std::string> allowed);

/// The names of a table of enumerators or factories.
template <NamedTable Table>
Limits one_of(const Table& table) {
  return one_of(names_of(table));
}

/// Returns the rule as text for error messages.
std::string describe_limits(const Limits& limits);

bool allows(const Limits& limits, double value);
bool allows(const Limits& limits, const std::string& value);

/// Checks one field; used through `validate`.
class Validator {
 public:
  explicit Validator(std::string prefix) : prefix_(std::move(prefix)) {}

  void operator()(const char* /*name*/, const bool& /*value*/, const Limits& = {}) const {}
  void operator()(const char* name, const int& value, const Limits& limits = {}) const;
  void operator()(const char* name, const std::uint64_t& value, const Limits& limits = {}) const;
  void operator()(const char* name, const double& value, const Limits& limits = {}) const;
  void operator()(const char* name, const std::string& value, const Limits& limits = {}) const;

  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& limits = {}) const {
    Validator nested(key(name));
    if constexpr (requires { value.begin(); }) {
      int index = 0;
      for (const auto& element : value) nested(std::to_string(index++).c_str(), element, limits);
    } else {
      Value::fields(value, nested);
    }
  }

 private:
  std::string key(const char* name) const;

  std::string prefix_;
};

/// Throws InputError "<prefix>.<field> = <value>: <rule>" for the first invalid field.
template <typename Settings>
void validate(const Settings& settings, const std::string& prefix = "") {
  Validator validator(prefix);
  Settings::fields(settings, validator);
}

}  // namespace patrol
