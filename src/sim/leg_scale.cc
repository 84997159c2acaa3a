#include "sim/leg_scale.h"

#include <algorithm>
#include <cmath>

namespace patrol::sim {
namespace {

// Robot for which the gains are tuned (models/quadruped).
constexpr double kTunedMass_kg = 13.56;
constexpr double kTunedLeg_m = 0.426;
constexpr double kTunedTorque_nm = 23.7;

}  // namespace

double rounded_to_percent(double ratio) { return std::round(100.0 * ratio) / 100.0; }

LegScale leg_scale(const RobotDescription& robot) {
  double leg_m = 0.0;
  for (const LegGeometry& leg : robot.legs) leg_m = std::max(leg_m, leg.length_m());
  const double length = leg_m / kTunedLeg_m;
  return {.length = length, .time = std::sqrt(length), .force = rounded_to_percent(robot.mass_kg / kTunedMass_kg)};
}

double motor_ratio(const RobotDescription& robot, std::size_t joint) {
  constexpr double kMaxTorqueOfWeight = 3.0;
  const LegScale scale = leg_scale(robot);
  return std::min(robot.joint_limits[joint].effort_nm / kTunedTorque_nm,
                  kMaxTorqueOfWeight * scale.force * scale.length);
}

}  // namespace patrol::sim
