#pragma once

#include <optional>

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

}  // namespace patrol::app
