#pragma once

#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "core/settings.h"
#include "sim/as_built/as_built_settings.h"

/// Loops over section `as_built`, for tests that hold for each of its numbers.
namespace patrol::sim {

/// Visitor that passes every number of section `as_built` to a function, with its name "group.field" and its limits.
template <typename Function>
struct ToleranceVisitor {
  Function function;
  std::string group;

  template <typename Value>
  void operator()(const char* name, Value& value, const Limits& limits = {}) {
    if constexpr (std::is_same_v<Value, double>) {
      function(fmt::format("{}.{}", group, name), value, limits);
    } else if constexpr (requires { Value::kSource; }) {
      group = name;
      Value::fields(value, *this);
    }
  }
};

template <typename Function>
void for_each_tolerance(AsBuiltSettings& settings, Function function) {
  ToleranceVisitor<Function> visitor{.function = std::move(function), .group = {}};
  AsBuiltSettings::fields(settings, visitor);
}

/// Returns whether 0 removes an error: false for ratios of noise, time constants and wavelengths.
inline bool is_tolerance(const std::string& name) {
  return !name.ends_with("_ratio") && name != "imu.warming_time_s" && name != "scanner.cyclic_wavelength_m";
}

/// Returns settings in which one number has its lowest value, which is 0 for a tolerance.
inline AsBuiltSettings without(AsBuiltSettings settings, const std::string& removed) {
  for_each_tolerance(settings, [&](const std::string& name, double& value, const Limits& limits) {
    if (name == removed) value = limits.min;
  });
  return settings;
}

/// Returns settings of an as-built robot without any error.
inline AsBuiltSettings exact() {
  AsBuiltSettings settings = AsBuiltSettings::as_delivered();
  for_each_tolerance(settings, [](const std::string& name, double& value, const Limits&) {
    if (name.ends_with("_ratio")) value = 1.0;
    if (is_tolerance(name)) value = 0.0;
  });
  return settings;
}

}  // namespace patrol::sim
