#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

namespace patrol::sim {

struct FootMotion {
  Eigen::Vector3d position;  ///< position, m
  Eigen::Vector3d velocity;  ///< velocity, m/s
};

/// Returns the trajectory of a foot from lift-off to touch-down: a cycloid along the ground, at rest at both ends. The
/// foot rises during the first kUp of the swing, stays at the apex, and descends from kDown on. So it clears the edge
/// of a step. `fraction` of the swing is 0 ... 1; the apex is `clearance_m` above the higher end.
inline FootMotion swing_foot(const Eigen::Vector3d& lift_off, const Eigen::Vector3d& touch_down, double clearance_m,
                             double fraction, double duration_s) {
  constexpr double pi = std::numbers::pi;
  const double s = std::clamp(fraction, 0.0, 1.0);
  const double along = s - std::sin(2.0 * pi * s) / (2.0 * pi);
  const double along_rate = (1.0 - std::cos(2.0 * pi * s)) / duration_s;
  FootMotion foot;
  foot.position = lift_off + along * (touch_down - lift_off);
  foot.velocity = along_rate * (touch_down - lift_off);

  constexpr double kUp = 0.4, kDown = 0.6;
  const double apex = std::max(lift_off.z(), touch_down.z()) + clearance_m;
  const bool rises = s<kUp, falls = s> kDown;
  const double from = rises ? lift_off.z() : touch_down.z();
  const double raised = rises ? s / kUp : falls ? (1.0 - s) / (1.0 - kDown) : 1.0;  // phase of the cosine, 0 ... 1
  const double raised_rate = rises ? 1.0 / kUp : falls ? -1.0 / (1.0 - kDown) : 0.0;
  foot.position.z() = from + (apex - from) * (1.0 - std::cos(pi * raised)) / 2.0;
  foot.velocity.z() = (apex - from) * pi * std::sin(pi * raised) * raised_rate / (2.0 * duration_s);
  return foot;
}

}  // namespace patrol::sim
