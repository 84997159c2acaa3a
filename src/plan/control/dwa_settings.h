#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct DwaSettings {
  // Limits of the robot.
  double max_speed_mps = 0.8;                ///< maximum forward speed
  double max_reverse_mps = 0.2;              ///< maximum backward speed
  double max_lateral_speed_mps = 0.0;        ///< maximum lateral speed in both directions; 0: no lateral motion
  double max_yaw_rate_radps = 0.9;           ///< maximum yaw rate
  double max_acceleration_mps2 = 0.8;        ///< maximum acceleration
  double max_yaw_acceleration_radps2 = 2.5;  ///< maximum yaw acceleration
  // Sampled commands.
  double window_s = 0.3;      ///< time in which a sampled command is reachable
  double horizon_s = 2.0;     ///< prediction horizon
  int steps = 8;              ///< number of poses along the prediction horizon
  int speed_samples = 6;      ///< number of sampled speeds
  int yaw_rate_samples = 15;  ///< number of sampled yaw rates
  int lateral_samples = 5;    ///< number of sampled lateral speeds, if there is lateral motion
  // Weights of the cost terms.
  double path_weight = 1.0;              ///< weight of the distance from the path
  double progress_weight = 1.2;          ///< weight of the progress along the path
  double heading_weight = 0.8;           ///< weight of the heading error
  double clearance_weight = 1.0;         ///< weight of the clearance from obstacles
  double command_change_weight = 0.1;    ///< weight of the change of the command
  double comfortable_clearance_m = 0.4;  ///< clearance from which on obstacles have no cost

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_speed_mps", self.max_speed_mps, between(0.05, 3.0));
    visit("max_reverse_mps", self.max_reverse_mps, between(0.0, 3.0));
    visit("max_lateral_speed_mps", self.max_lateral_speed_mps, between(0.0, 3.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.05, 5.0));
    visit("max_acceleration_mps2", self.max_acceleration_mps2, between(0.05, 10.0));
    visit("max_yaw_acceleration_radps2", self.max_yaw_acceleration_radps2, between(0.05, 50.0));
    visit("window_s", self.window_s, between(0.02, 2.0));
    visit("horizon_s", self.horizon_s, between(0.2, 10.0));
    visit("steps", self.steps, between(2, 100));
    visit("speed_samples", self.speed_samples, between(2, 100));
    visit("yaw_rate_samples", self.yaw_rate_samples, between(3, 201));
    visit("lateral_samples", self.lateral_samples, between(3, 101));
    visit("path_weight", self.path_weight, at_least(0.0));
    visit("progress_weight", self.progress_weight, at_least(0.0));
    visit("heading_weight", self.heading_weight, at_least(0.0));
    visit("clearance_weight", self.clearance_weight, at_least(0.0));
    visit("command_change_weight", self.command_change_weight, at_least(0.0));
    visit("comfortable_clearance_m", self.comfortable_clearance_m, between(0.01, 5.0));
  }
};

}  // namespace patrol::plan
