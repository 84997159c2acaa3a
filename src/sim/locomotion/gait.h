#pragma once

#include <array>
#include <cmath>

namespace patrol::sim {

inline constexpr int kNumLegs = 4;  ///< order: FL, FR, RL, RR

/// Trot: diagonal pairs alternate, each foot in stance for `duty` of the period.
struct Gait {
  double period_s = 0.44;
  double duty = 0.58;

  double stance_s() const { return duty * period_s; }
  double swing_s() const { return (1.0 - duty) * period_s; }
};

/// Phase of a leg in the gait. `fraction` increases from 0 to 1 during its stance or its swing.
struct LegPhase {
  bool is_stance = true;
  double fraction = 0.0;
};

/// Returns the phase of a leg. `cycle` counts periods; FL and RR begin their stance at whole numbers, FR and RL half a
/// period later.
inline LegPhase leg_phase(const Gait& gait, double cycle, int leg) {
  const double offset = (leg == 0 || leg == 3) ? 0.0 : 0.5;
  const double phase = cycle + offset - std::floor(cycle + offset);
  if (phase < gait.duty) return {true, phase / gait.duty};
  return {false, (phase - gait.duty) / (1.0 - gait.duty)};
}

}  // namespace patrol::sim
