#pragma once

#include <optional>
#include <vector>

#include "core/settings.h"
#include "plan/control/dwa_liu21_settings.h"
#include "plan/control/local_planner.h"
#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

/// Rectangle of velocity pairs (v, omega).
struct VelocityWindow {
  double min_speed_mps, max_speed_mps;
  double min_yaw_rate_radps, max_yaw_rate_radps;
};

/// Velocity limits of the robot V_m [Liu21, eq. 2].
VelocityWindow speed_window(const DwaLiu21Settings& settings);
/// Velocities V_d reachable within `window_s` from (v_c, omega_c) [Liu21, eq. 3].
VelocityWindow reachable_window(const DwaLiu21Settings& settings, double speed_mps, double yaw_rate_radps);
/// Intersection of two windows; the nearest edge of the first one if it is empty.
VelocityWindow intersect(const VelocityWindow& limits, const VelocityWindow& window);
/// Whether the robot can stop within `distance_m` [Liu21, eq. 4].
bool can_stop(const DwaLiu21Settings& settings, double speed_mps, double yaw_rate_radps, double distance_m);
/// Heading term [Liu21, eq. 6]; `angle_rad` is between the heading at the trajectory's end and the target point.
double heading_term(double angle_rad);
/// Velocity term [Liu21, eq. 7].
double velocity_term(const DwaLiu21Settings& settings, double speed_mps);
/// Divides by the sum, so that the values sum to 1; leaves all zeros unchanged.
void normalize(std::vector<double>& values);

/// Dynamic window approach as printed in [Liu21, section 3.2, eqs. 2-7]: of the velocity pairs of V_s = V_m and V_d and
/// V_a the one with the maximum of
///
///   G = alpha heading + beta dist + gamma velocity,
///
/// each term normalized over the pairs. It serves for comparison with the default, plan/control/dwa.h.
///
/// Deviations from [Liu21] and interpretations:
///
///   eq. 3   the upper bounds are printed "v_c - a_vmax dt", "omega_c - a_omegamax dt"; here with plus.
///   eq. 4   omega <= sqrt(2 dis a_omegamin) takes a distance in meters for an angle, as in [Fox97]; used as printed,
///           for |omega| and |v|.
///   eq. 5   sigma is not explained; in [Fox97] it smooths over neighbors. Here it is the identity, and each term is
///           divided by its sum, the normalization that the text requires. "dist" of eq. 5 is "dis" of the text: the
///           minimum distance of the trajectory to obstacles, here from the robot's outline.
///   eq. 7   (v, omega) / (v_max, omega_max) is not a scalar; here v / v_max, as in [Fox97].
///   target  the target point is not specified; here a point on the global path, `lookahead_m` ahead.
class DwaLiu21 final : public LocalPlanner {
 public:
  /// Throws InputError if a setting breaks its rule.
  explicit DwaLiu21(const DwaLiu21Settings& settings);

  std::optional<VelocityCommand> choose(const Costmap& costmap, const PlannedPath& path, double along_m,
                                        const Pose2& T_map_body, const Twist3& twist,
                                        double speed_limit_mps) const override;

 private:
  std::vector<Rollout> admissible(const Costmap& costmap, const Pose2& T_map_body, const VelocityWindow& window) const;

  DwaLiu21Settings settings_;
};

}  // namespace patrol::plan
