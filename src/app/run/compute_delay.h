#pragma once

#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/time.h"
#include "stack/settings/stack_settings.h"

namespace patrol::app {

/// Returns the time from the start of a turn until its messages take effect. `cpu_s`: CPU time of the turn.
inline Time delay_of(const stack::ComputeSettings& compute, double cpu_s) {
  if (compute.model == "fixed") return from_seconds(compute.delay_s);
  return compute.model == "measured" ? from_seconds(compute.factor * cpu_s) : Time{};
}

/// Returns that time if it does not depend on the turn.
inline std::optional<Time> known_delay_of(const stack::ComputeSettings& compute) {
  return compute.model == "measured" ? std::nullopt : std::optional(delay_of(compute, 0.0));
}

/// Returns a warning of settings that the model of the computing time does not use; empty without one.
inline std::string warning_of_unused(const stack::ComputeSettings& compute) {
  const stack::ComputeSettings defaults;
  const auto warning = [&](const char* key, double value, const char* model) {
    return fmt::format("stack.compute.{} = {:g}: no effect with stack.compute.model = {}: needs {}", key, value,
                       compute.model, model);
  };
  if (compute.model != "fixed" && compute.delay_s != defaults.delay_s)
    return warning("delay_s", compute.delay_s, "fixed");
  if (compute.model != "measured" && compute.factor != defaults.factor)
    return warning("factor", compute.factor, "measured");
  return {};
}

}  // namespace patrol::app
