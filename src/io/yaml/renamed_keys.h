#pragma once

#include <span>
#include <string_view>

namespace patrol::io {

/// Settings key that was renamed.
struct RenamedKey {
  std::string_view before;  ///< former path with the present names of its parents; a leading `*` stands for any parents
  std::string_view now;     ///< present path, or `*` with the same parents
};

/// Renamed keys of sensors, robot, world and scenario.
std::span<const RenamedKey> renamed_scenario_keys();

/// Renamed keys of the stack, and of `patrol slam`, `calibrate`, `train-neighbors` and `plan`.
std::span<const RenamedKey> renamed_stack_keys();

}  // namespace patrol::io
