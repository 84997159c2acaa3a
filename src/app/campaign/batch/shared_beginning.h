#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "app/scenario/scenario.h"
#include "core/time.h"

namespace patrol::app {

/// Beginning of a run that another run has as well.
struct SharedBeginning {
  std::size_t leader = 0;  ///< index of the run that computes the beginning
  Time until{};            ///< instant before the first event that differs
};

/// Finds for each scenario the run from which it can branch: a scenario that differs only in faults and kidnaps from an
/// instant on, at least `min_s` after the start, and in its expectations. None for leaders, and for runs whose state
/// cannot be saved.
std::vector<std::optional<SharedBeginning>> shared_beginnings(const std::vector<Scenario>& scenarios, double min_s);

}  // namespace patrol::app
