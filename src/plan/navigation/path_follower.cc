#include "plan/navigation/path_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plan/navigation/motion_check.h"

namespace patrol::plan {
namespace {

constexpr double kMinSpeed_mps = 0.15;  // minimum speed toward the end of the path

Twist3 twist_of(const VelocityCommand& command) {
  return {.linear = {command.vx_mps, command.vy_mps, 0.0}, .angular = {0.0, 0.0, command.yaw_rate_radps}};
}

}  // namespace

PathFollower::PathFollower(const NavigatorSettings& settings)
    : settings_(settings),
      local_planner_(row_named(local_planners(), settings.local_planner.method, "navigation.local_planner.method")
                         .make(settings.local_planner)) {}

void PathFollower::set_path(PlannedPath path, const Pose2& T_map_body) {
  path_ = std::move(path);
  along_m_ = path_.project(T_map_body.position(), 0.0, path_.length_m()).along_m;
}

double PathFollower::advance(const Pose2& T_map_body) {
  const PathProjection here = path_.project(T_map_body.position(), std::max(0.0, along_m_ - 0.5), along_m_ + 2.0);
  along_m_ = here.along_m;
  return here.distance_m;
}

double PathFollower::ahead_end_m() const {
  return std::min(path_.length_m(), along_m_ + settings_.path_check_distance_m);
}

bool PathFollower::is_blocked(const Costmap& costmap) const {
  const double to_m = ahead_end_m();
  for (double along_m = along_m_; along_m < to_m; along_m += costmap.settings().resolution_m) {
    if (costmap.cost_at(path_.point_at(along_m)) == kLethalCost) return true;
  }
  return false;
}

bool PathFollower::is_blocked_by_new_obstacles_only(const Costmap& costmap, Time now) const {
  const CostmapSettings& settings = costmap.settings();
  const double radius_m = costmap.footprint().inscribed_radius_m() + settings.safety_margin_m +
                          settings.route_margin_m + 2.0 * settings.resolution_m;
  const double to_m = ahead_end_m();
  for (double along_m = along_m_; along_m < to_m; along_m += settings.resolution_m) {
    const Eigen::Vector2d p_map = path_.point_at(along_m);
    if (costmap.cost_at(p_map) != kLethalCost) continue;
    const std::optional<Time> since = costmap.obstacle_first_seen(p_map, radius_m);
    if (!since || now - *since >= from_seconds(settings_.new_obstacle_wait_s)) return false;
  }
  return true;
}

VelocityCommand PathFollower::command(const Costmap& costmap, const Pose2& T_map_body,
                                      const VelocityCommand& last) const {
  if (const std::optional<VelocityCommand> turn = turn_in_place(costmap, T_map_body, last)) return *turn;
  const double braking_mps = std::sqrt(2.0 * settings_.approach_deceleration_mps2 * std::max(0.0, remaining_m()));
  double speed_limit_mps = std::max(kMinSpeed_mps, braking_mps);
  if (is_unmapped_obstacle_ahead(costmap, T_map_body))
    speed_limit_mps = std::min(speed_limit_mps, settings_.unmapped_obstacle_max_speed_mps);
  return local_planner_->choose(costmap, path_, along_m_, T_map_body, twist_of(last), speed_limit_mps)
      .value_or(VelocityCommand{});
}

bool PathFollower::is_unmapped_obstacle_ahead(const Costmap& costmap, const Pose2& T_map_body) const {
  if (settings_.unmapped_obstacle_slowdown_distance_m <= 0.0) return false;
  const double radius_m = settings_.unmapped_obstacle_slowdown_distance_m / 2.0;
  return costmap.obstacle_first_seen(T_map_body * Eigen::Vector2d(radius_m, 0.0), radius_m).has_value();
}

/// Command to turn in place if the path leads off by more than `turn_in_place_threshold_rad` and there is room for it.
std::optional<VelocityCommand> PathFollower::turn_in_place(const Costmap& costmap, const Pose2& T_map_body,
                                                           const VelocityCommand& last) const {
  const Eigen::Vector2d ahead = path_.point_at(along_m_ + 0.5) - T_map_body.position();
  if (ahead.norm() < 0.1) return std::nullopt;
  const double turn = wrap_angle(std::atan2(ahead.y(), ahead.x()) - T_map_body.yaw);
  const bool is_turning = std::abs(last.yaw_rate_radps) > 0.3 && std::abs(last.vx_mps) < 0.01;
  if (std::abs(turn) < (is_turning ? 0.35 : settings_.turn_in_place_threshold_rad)) return std::nullopt;
  const VelocityCommand command{.yaw_rate_radps = std::copysign(settings_.turn_in_place_rate_radps, turn)};
  if (!is_motion_safe(costmap, T_map_body, command, 0.6)) return std::nullopt;
  return command;
}

}  // namespace patrol::plan
