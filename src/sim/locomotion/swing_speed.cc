#include "sim/locomotion/swing_speed.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/LU>

#include "core/leg_kinematics.h"
#include "sim/leg_scale.h"
#include "sim/locomotion/gait.h"
#include "sim/locomotion/swing_trajectory.h"

namespace patrol::sim {
namespace {

constexpr double kMaxRatio = 0.82;  // the control of the swing adds a tenth
constexpr double kMinClearanceRatio = 0.6, kMinForward_mps = 0.1;
constexpr double kStepClearance_m = 0.08, kMaxClearanceOfLeg = 0.27;
constexpr double kMaxRaisedRatio = 1.4;
constexpr double kMaxPeriodRatio = 1.5, kKeptSpeedRatio = 0.35;
constexpr int kSamples = 40;

/// Moves the joints until the foot is at a position in body: Newton's method from a posture near it.
void reach(const LegGeometry& leg, const Eigen::Vector3d& foot_in_body, Eigen::Vector3d& joint_rad) {
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Eigen::Vector3d step =
        foot_jacobian(leg, joint_rad).fullPivLu().solve(foot_in_body - foot_position(leg, joint_rad));
    joint_rad += step.cwiseMax(-0.3).cwiseMin(0.3);
  }
}

/// Returns the largest value in [low, high] that `is_allowed`, or `low`; values below an allowed one are allowed.
template <typename Predicate>
double largest(double low, double high, Predicate is_allowed) {
  if (is_allowed(high)) return high;
  for (int i = 0; i < 20; ++i) (is_allowed(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

}  // namespace

double peak_swing_speed_ratio(const RobotDescription& robot, const LocomotionSettings& settings, double forward_mps) {
  const Gait gait{.period_s = settings.gait_period_s, .duty = settings.gait_duty};
  const Eigen::Vector3d half_step(0.5 * forward_mps * gait.stance_s(), 0.0, 0.0);
  double peak = 0.0;
  for (std::size_t l = 0; l < robot.legs.size(); ++l) {
    const LegGeometry& leg = robot.legs[l];
    Eigen::Vector3d joint_rad = leg.standing_rad;
    Eigen::Vector3d middle = foot_position(leg, joint_rad);
    middle.z() = -settings.trunk_height_m;
    for (int i = 0; i <= kSamples; ++i) {
      const FootMotion foot = swing_foot(middle - half_step, middle + half_step, settings.swing_clearance_m,
                                         static_cast<double>(i) / kSamples, gait.swing_s());
      reach(leg, foot.position, joint_rad);
      const Eigen::Vector3d rate_radps = foot_jacobian(leg, joint_rad).fullPivLu().solve(foot.velocity);
      for (std::size_t k = 0; k < 3; ++k) {
        const double limit_radps = robot.joint_limits[3 * l + k].velocity_radps;
        peak = std::max(peak, std::abs(rate_radps[static_cast<Eigen::Index>(k)]) / limit_radps);
      }
    }
  }
  return peak;
}

double min_swing_clearance_m(const RobotDescription& robot) {
  return kMinClearanceRatio * leg_scale(robot).length * LocomotionSettings{}.swing_clearance_m;
}

double step_clearance_m(const RobotDescription& robot) {
  double leg_m = 0.0;
  for (const LegGeometry& leg : robot.legs) leg_m = std::max(leg_m, leg.length_m());
  return std::min(kStepClearance_m, kMaxClearanceOfLeg * leg_m);
}

void limit_to_joint_speeds(const RobotDescription& robot, LocomotionSettings& settings) {
  const auto are_fast_enough = [&](const LocomotionSettings& changed, double forward_mps) {
    return peak_swing_speed_ratio(robot, changed, forward_mps) <= kMaxRatio;
  };
  const double nominal_mps = settings.max_forward_mps, nominal_s = settings.gait_period_s;
  settings.swing_clearance_m =
      largest(kMinClearanceRatio * settings.swing_clearance_m, settings.swing_clearance_m, [&](double clearance_m) {
        LocomotionSettings changed = settings;
        changed.swing_clearance_m = clearance_m;
        return are_fast_enough(changed, nominal_mps);
      });
  settings.gait_period_s = nominal_s / largest(1.0 / kMaxPeriodRatio, 1.0, [&](double frequency_ratio) {
                             LocomotionSettings changed = settings;
                             changed.gait_period_s = nominal_s / frequency_ratio;
                             return are_fast_enough(changed, kKeptSpeedRatio * nominal_mps);
                           });
  settings.max_forward_mps = largest(std::min(kMinForward_mps, nominal_mps), nominal_mps,
                                     [&](double mps) { return are_fast_enough(settings, mps); });
  if (!are_fast_enough(settings, settings.max_forward_mps)) return;
  const double low_m = settings.swing_clearance_m, step_m = std::max(low_m, step_clearance_m(robot));
  settings.swing_clearance_m = largest(low_m, step_m, [&](double clearance_m) {
    LocomotionSettings raised = settings;
    raised.swing_clearance_m = clearance_m;
    return peak_swing_speed_ratio(robot, raised, settings.max_forward_mps) <= kMaxRaisedRatio;
  });
  settings.max_forward_mps = std::max(std::min(kMinForward_mps, settings.max_forward_mps),
                                      low_m / settings.swing_clearance_m * settings.max_forward_mps);
}

}  // namespace patrol::sim
