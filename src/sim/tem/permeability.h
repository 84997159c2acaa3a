#pragma once

#include <numbers>

namespace patrol::sim {

inline constexpr double kPermeability = 4e-7 * std::numbers::pi;  ///< permeability of the vacuum, V s / (A m)

}  // namespace patrol::sim
