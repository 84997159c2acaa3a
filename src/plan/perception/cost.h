#pragma once

#include <cmath>
#include <cstdint>

namespace patrol::plan {

/// Cost of a costmap cell: 0 free ... kMaxPassableCost passable, kLethalCost lethal.
using Cost = std::uint8_t;
inline constexpr Cost kFreeCost = 0;
inline constexpr Cost kMaxPassableCost = 252;
inline constexpr Cost kLethalCost = 255;

/// Cost at `beyond_m` beyond the lethal distance, falling to 1/e over `decay_m`.
inline Cost decaying_cost(double beyond_m, double decay_m) {
  return static_cast<Cost>(std::lround(kMaxPassableCost * std::exp(-beyond_m / decay_m)));
}

}  // namespace patrol::plan
