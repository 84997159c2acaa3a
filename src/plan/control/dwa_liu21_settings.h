#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct DwaLiu21Settings {
  double min_speed_mps = 0.0;                ///< minimum speed, v_min
  double max_speed_mps = 0.8;                ///< maximum speed, v_max
  double max_yaw_rate_radps = 0.6;           ///< maximum yaw rate in both directions, omega_max = -omega_min
  double max_deceleration_mps2 = 0.5;        ///< maximum deceleration, a_vmin
  double max_acceleration_mps2 = 0.5;        ///< maximum acceleration, a_vmax
  double max_yaw_deceleration_radps2 = 1.5;  ///< maximum yaw deceleration, a_omegamin
  double max_yaw_acceleration_radps2 = 1.5;  ///< maximum yaw acceleration, a_omegamax
  double window_s = 0.3;                     ///< time in which a sampled command is reachable, Delta t
  double horizon_s = 2.0;                    ///< horizon of the simulated trajectory
  int steps = 8;                             ///< number of poses along the simulated trajectory
  int speed_samples = 7;                     ///< number of sampled speeds
  int yaw_rate_samples = 15;                 ///< number of sampled yaw rates
  double heading_weight = 0.8;               ///< weight of the heading term, alpha
  double distance_weight = 0.2;              ///< weight of the distance term, beta
  double velocity_weight = 0.2;              ///< weight of the velocity term, gamma
  double lookahead_m = 1.5;                  ///< distance of the target point ahead along the path

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_speed_mps", self.min_speed_mps, between(-3.0, 0.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.05, 3.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.05, 5.0));
    visit("max_deceleration_mps2", self.max_deceleration_mps2, between(0.05, 10.0));
    visit("max_acceleration_mps2", self.max_acceleration_mps2, between(0.05, 10.0));
    visit("max_yaw_deceleration_radps2", self.max_yaw_deceleration_radps2, between(0.05, 50.0));
    visit("max_yaw_acceleration_radps2", self.max_yaw_acceleration_radps2, between(0.05, 50.0));
    visit("window_s", self.window_s, between(0.02, 2.0));
    visit("horizon_s", self.horizon_s, between(0.2, 10.0));
    visit("steps", self.steps, between(2, 100));
    visit("speed_samples", self.speed_samples, between(2, 100));
    visit("yaw_rate_samples", self.yaw_rate_samples, between(3, 201));
    visit("heading_weight", self.heading_weight, at_least(0.0));
    visit("distance_weight", self.distance_weight, at_least(0.0));
    visit("velocity_weight", self.velocity_weight, at_least(0.0));
    visit("lookahead_m", self.lookahead_m, between(0.1, 20.0));
  }
};

}  // namespace patrol::plan
