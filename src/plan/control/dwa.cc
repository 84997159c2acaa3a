#include "plan/control/dwa.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::plan {
namespace {

constexpr double kMinReachableSpeed_mps = 0.2;  // minimum of the speed that determines the reachable distance

/// Uniform samples from `low` to `high`, both included; contains zero if it lies between them.
std::vector<double> samples(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  if (low < 0.0 && high > 0.0) values.push_back(0.0);
  return values;
}

}  // namespace

DynamicWindow::DynamicWindow(const DwaSettings& settings)
    : settings_(settings), clearance_{.comfortable_m = settings.comfortable_clearance_m} {}

double DynamicWindow::cost(const Rollout& rollout, const RolloutScene& scene) const {
  return settings_.path_weight * path_distance_(rollout, scene) +
         settings_.progress_weight * progress_(rollout, scene) + settings_.heading_weight * heading_(rollout, scene) +
         settings_.clearance_weight * clearance_(rollout, scene) +
         settings_.command_change_weight * change_(rollout, scene);
}

std::vector<double> DynamicWindow::reachable_lateral_speeds(double lateral_mps) const {
  const double max_mps = settings_.max_lateral_speed_mps;
  if (max_mps <= 0.0) return {0.0};
  const double window_mps = settings_.max_acceleration_mps2 * settings_.window_s;
  const double now_mps = std::clamp(lateral_mps, -max_mps, max_mps);
  return samples(std::max(-max_mps, now_mps - window_mps), std::min(max_mps, now_mps + window_mps),
                 settings_.lateral_samples);
}

std::optional<VelocityCommand> DynamicWindow::choose(const Costmap& costmap, const PlannedPath& path, double along_m,
                                                     const Pose2& T_map_body, const Twist3& twist,
                                                     double speed_limit_mps) const {
  const double top_speed = std::min(settings_.max_speed_mps, speed_limit_mps);
  const double speed = std::clamp(twist.linear.x(), -settings_.max_reverse_mps, settings_.max_speed_mps);
  const double yaw_rate = std::clamp(twist.angular.z(), -settings_.max_yaw_rate_radps, settings_.max_yaw_rate_radps);
  const double speed_window = settings_.max_acceleration_mps2 * settings_.window_s;
  const double yaw_window = settings_.max_yaw_acceleration_radps2 * settings_.window_s;
  // Braking is always admissible, also from above a limit that has just fallen.
  const double max_reachable = std::max(std::min(top_speed, speed + speed_window), std::max(0.0, speed - speed_window));
  const double min_reachable = std::min(std::max(0.0, speed - speed_window), max_reachable);

  // Progress is relative to the distance reachable now: to a robot at rest before a narrow passage, slow motion must
  // not be rated like standing still.
  const RolloutScene scene{.path = path,
                           .along_m = along_m,
                           .reachable_distance_m =
                               std::max(max_reachable, kMinReachableSpeed_mps) * settings_.horizon_s,
                           .twist = twist,
                           .max_speed_mps = settings_.max_speed_mps,
                           .max_yaw_rate_radps = settings_.max_yaw_rate_radps,
                           .max_lateral_speed_mps = settings_.max_lateral_speed_mps};
  const std::vector<double> lateral_speeds = reachable_lateral_speeds(twist.linear.y());
  const double clearance_now = costmap.clearance_m(T_map_body);
  const bool is_in_collision = clearance_now < 0.0;
  std::optional<VelocityCommand> best;
  double best_cost = std::numeric_limits<double>::infinity();
  for (const double vx : samples(min_reachable, max_reachable, settings_.speed_samples)) {
    for (const double yaw :
         samples(std::max(-settings_.max_yaw_rate_radps, yaw_rate - yaw_window),
                 std::min(settings_.max_yaw_rate_radps, yaw_rate + yaw_window), settings_.yaw_rate_samples)) {
      for (const double vy : lateral_speeds) {
        const Rollout rollout = roll_out(costmap, T_map_body, vx, yaw, settings_.horizon_s, settings_.steps, vy,
                                         /*until_contact=*/!is_in_collision);
        const bool leads_away = is_in_collision &&
                                costmap.clearance_m(rollout.T_map_body.back()) > clearance_now + 0.02 &&
                                rollout.min_clearance_m > clearance_now - 0.02;
        if (rollout.min_clearance_m <= 0.0 && !leads_away) continue;
        const double total = cost(rollout, scene);
        if (total < best_cost) {
          best_cost = total;
          best = VelocityCommand{.stamp = {}, .vx_mps = vx, .vy_mps = vy, .yaw_rate_radps = yaw};
        }
      }
    }
  }
  return best;
}

}  // namespace patrol::plan
