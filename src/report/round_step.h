#pragma once

#include <cmath>

namespace patrol::report {

/// Minimum of 1, 2 or 5 times a power of ten that covers `end` with at most `max_steps` steps.
inline double round_step(double end, int max_steps) {
  const double min = end / max_steps, power = std::pow(10.0, std::floor(std::log10(min)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= min * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace patrol::report
