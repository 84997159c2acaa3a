#include "plan/control/dwa_liu21.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace patrol::plan {

VelocityWindow speed_window(const DwaLiu21Settings& settings) {
  return {.min_speed_mps = settings.min_speed_mps,
          .max_speed_mps = settings.max_speed_mps,
          .min_yaw_rate_radps = -settings.max_yaw_rate_radps,
          .max_yaw_rate_radps = settings.max_yaw_rate_radps};
}

VelocityWindow reachable_window(const DwaLiu21Settings& settings, double speed_mps, double yaw_rate_radps) {
  const double dt_s = settings.window_s;
  return {.min_speed_mps = speed_mps - settings.max_deceleration_mps2 * dt_s,
          .max_speed_mps = speed_mps + settings.max_acceleration_mps2 * dt_s,
          .min_yaw_rate_radps = yaw_rate_radps - settings.max_yaw_deceleration_radps2 * dt_s,
          .max_yaw_rate_radps = yaw_rate_radps + settings.max_yaw_acceleration_radps2 * dt_s};
}

VelocityWindow intersect(const VelocityWindow& limits, const VelocityWindow& window) {
  const auto within_speed = [&](double speed) { return std::clamp(speed, limits.min_speed_mps, limits.max_speed_mps); };
  const auto within_rate = [&](double rate) {
    return std::clamp(rate, limits.min_yaw_rate_radps, limits.max_yaw_rate_radps);
  };
  return {.min_speed_mps = within_speed(window.min_speed_mps),
          .max_speed_mps = within_speed(window.max_speed_mps),
          .min_yaw_rate_radps = within_rate(window.min_yaw_rate_radps),
          .max_yaw_rate_radps = within_rate(window.max_yaw_rate_radps)};
}

bool can_stop(const DwaLiu21Settings& settings, double speed_mps, double yaw_rate_radps, double distance_m) {
  const double free_m = std::max(0.0, distance_m);
  return std::abs(speed_mps) <= std::sqrt(2.0 * free_m * settings.max_deceleration_mps2) &&
         std::abs(yaw_rate_radps) <= std::sqrt(2.0 * free_m * settings.max_yaw_deceleration_radps2);
}

double heading_term(double angle_rad) { return 1.0 - std::abs(wrap_angle(angle_rad)) / std::numbers::pi; }

double velocity_term(const DwaLiu21Settings& settings, double speed_mps) { return speed_mps / settings.max_speed_mps; }

void normalize(std::vector<double>& values) {
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  if (sum <= 0.0) return;
  for (double& value : values) value /= sum;
}

DwaLiu21::DwaLiu21(const DwaLiu21Settings& settings) : settings_(settings) { validate(settings_, "dwa_liu21"); }

/// Velocity pairs of V_s, each with its trajectory.
std::vector<Rollout> DwaLiu21::admissible(const Costmap& costmap, const Pose2& T_map_body,
                                          const VelocityWindow& window) const {
  const auto sample = [](double low, double high, int i, int count) { return low + (high - low) * i / (count - 1); };
  std::vector<Rollout> rollouts;
  for (int i = 0; i < settings_.speed_samples; ++i) {
    const double speed = sample(window.min_speed_mps, window.max_speed_mps, i, settings_.speed_samples);
    for (int j = 0; j < settings_.yaw_rate_samples; ++j) {
      const double rate = sample(window.min_yaw_rate_radps, window.max_yaw_rate_radps, j, settings_.yaw_rate_samples);
      Rollout rollout = roll_out(costmap, T_map_body, speed, rate, settings_.horizon_s, settings_.steps);
      if (can_stop(settings_, speed, rate, rollout.min_clearance_m)) rollouts.push_back(std::move(rollout));
    }
  }
  return rollouts;
}

std::optional<VelocityCommand> DwaLiu21::choose(const Costmap& costmap, const PlannedPath& path, double along_m,
                                                const Pose2& T_map_body, const Twist3& twist,
                                                double speed_limit_mps) const {
  VelocityWindow limits = speed_window(settings_);
  limits.max_speed_mps = std::max(limits.min_speed_mps, std::min(limits.max_speed_mps, speed_limit_mps));
  const VelocityWindow window = intersect(limits, reachable_window(settings_, twist.linear.x(), twist.angular.z()));
  const std::vector<Rollout> rollouts = admissible(costmap, T_map_body, window);
  if (rollouts.empty()) return std::nullopt;

  const Eigen::Vector2d p_map_target = path.point_at(along_m + settings_.lookahead_m);
  std::vector<double> heading, distance, velocity;
  for (const Rollout& rollout : rollouts) {
    const Pose2& end = rollout.T_map_body.back();
    const Eigen::Vector2d to_target = p_map_target - end.position();
    heading.push_back(heading_term(std::atan2(to_target.y(), to_target.x()) - end.yaw));
    distance.push_back(std::max(0.0, rollout.min_clearance_m));
    velocity.push_back(std::max(0.0, velocity_term(settings_, rollout.vx_mps)));
  }
  normalize(heading);
  normalize(distance);
  normalize(velocity);
  std::size_t best = 0;
  double best_value = -1.0;
  for (std::size_t i = 0; i < rollouts.size(); ++i) {
    const double value = settings_.heading_weight * heading[i] + settings_.distance_weight * distance[i] +
                         settings_.velocity_weight * velocity[i];
    if (value <= best_value) continue;
    best = i;
    best_value = value;
  }
  return VelocityCommand{
      .stamp = {}, .vx_mps = rollouts[best].vx_mps, .vy_mps = 0.0, .yaw_rate_radps = rollouts[best].yaw_rate_radps};
}

}  // namespace patrol::plan
