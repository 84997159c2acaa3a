#pragma once

#include <optional>
#include <vector>

#include "core/settings.h"
#include "plan/control/local_planner.h"
#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

struct PaperDwaSettings {
  double min_speed_mps = 0.0;            ///< v_min
  double max_speed_mps = 0.8;            ///< v_max
  double max_yaw_rate_radps = 0.6;       ///< omega_max = -omega_min
  double max_decel_mps2 = 0.5;           ///< a_vmin
  double max_accel_mps2 = 0.5;           ///< a_vmax
  double max_yaw_decel_radps2 = 1.5;     ///< a_omegamin
  double max_yaw_accel_radps2 = 1.5;     ///< a_omegamax
  double window_s = 0.3;                 ///< Delta t
  double horizon_s = 2.0;                ///< of the simulated trajectory
  int steps = 8;
  int speed_samples = 7;
  int yaw_rate_samples = 15;
  double heading_weight = 0.8;           ///< alpha
  double distance_weight = 0.2;          ///< beta
  double velocity_weight = 0.2;          ///< gamma
  double target_ahead_m = 1.5;           ///< the target point: so far on along the path

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_speed_mps", self.min_speed_mps, between(-3.0, 0.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.05, 3.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.05, 5.0));
    visit("max_decel_mps2", self.max_decel_mps2, between(0.05, 10.0));
    visit("max_accel_mps2", self.max_accel_mps2, between(0.05, 10.0));
    visit("max_yaw_decel_radps2", self.max_yaw_decel_radps2, between(0.05, 50.0));
    visit("max_yaw_accel_radps2", self.max_yaw_accel_radps2, between(0.05, 50.0));
    visit("window_s", self.window_s, between(0.02, 2.0));
    visit("horizon_s", self.horizon_s, between(0.2, 10.0));
    visit("steps", self.steps, between(2, 100));
    visit("speed_samples", self.speed_samples, between(2, 100));
    visit("yaw_rate_samples", self.yaw_rate_samples, between(3, 201));
    visit("heading_weight", self.heading_weight, at_least(0.0));
    visit("distance_weight", self.distance_weight, at_least(0.0));
    visit("velocity_weight", self.velocity_weight, at_least(0.0));
    visit("target_ahead_m", self.target_ahead_m, between(0.1, 20.0));
  }
};

/// A rectangle of velocity pairs (v, omega).
struct VelocityWindow {
  double min_speed_mps, max_speed_mps;
  double min_yaw_rate_radps, max_yaw_rate_radps;
};

/// Eq. 2: what the robot can do at all.
VelocityWindow speed_window(const PaperDwaSettings& settings);
/// Eq. 3: what it can reach within the window from (v_c, omega_c).
VelocityWindow reachable_window(const PaperDwaSettings& settings, double speed_mps, double yaw_rate_radps);
/// The part common to both; the first one's nearest edge where there is none.
VelocityWindow intersect(const VelocityWindow& limits, const VelocityWindow& window);
/// Eq. 4: whether it can stop before what is `distance_m` away.
bool can_stop(const PaperDwaSettings& settings, double speed_mps, double yaw_rate_radps, double distance_m);
/// Eq. 6, of the angle between the heading at the trajectory's end and the target point.
double heading_term(double angle_rad);
/// Eq. 7.
double velocity_term(const PaperDwaSettings& settings, double speed_mps);
/// Divides by the sum, so that the values sum to 1; leaves zeros.
void normalize(std::vector<double>& values);

/// The dynamic window approach as paper 004 prints it (Liu, Zhu, "Research on autonomous navigation method of tunnel safety early
/// warning robot", 2021, section 3.2, eqs. 2-7): of the velocity pairs of V_s = V_m and V_d and V_a the one of the largest
///
///   G = alpha heading + beta dist + gamma velocity,
///
/// each term normalised over the pairs. It stands beside plan/control/dwa.h, which is the default, for comparison. How we read it:
///
///   eq. 3   the upper bounds are printed "v_c - a_vmax dt", "omega_c - a_omegamax dt": they must be plus.
///   eq. 4   omega <= sqrt(2 dis a_omegamin) takes a distance in metres for an angle, as Fox, Burgard, Thrun (1997) do; taken
///           as it stands, for |omega| and |v|.
///   eq. 5   sigma is not explained; in Fox et al. it smooths over neighbours. Here it is the identity, and the normalisation that the text
///           asks for divides each term by its sum. "dist" of eq. 5 is "dis" of the text: the least distance of the
///           trajectory to obstacles, here from the robot's outline.
///   eq. 7   (v, omega) / (v_max, omega_max) is no number; taken is v / v_max, as in Fox et al.
///   target  the paper does not say which point: one on the global path some way ahead.
class PaperDwa final : public LocalPlanner {
 public:
  /// Throws InputError if a setting breaks its rule.
  explicit PaperDwa(const PaperDwaSettings& settings);

  std::optional<VelocityCommand> choose(const Costmap& costmap, const PlannedPath& path, double along_m,
                                        const Pose2& T_map_body, const Twist3& twist,
                                        double speed_limit_mps) const override;

 private:
  std::vector<Rollout> admissible(const Costmap& costmap, const Pose2& T_map_body, const VelocityWindow& window) const;

  PaperDwaSettings settings_;
};

}  // namespace patrol::plan
