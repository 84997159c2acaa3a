#include "plan/navigation/path_follower.h"

#include <cmath>

#include "plan/navigation/motion_check.h"

namespace patrol::plan {
namespace {

Twist3 twist_of(const VelocityCommand& command) {
  return {.linear = {command.vx_mps, command.vy_mps, 0.0}, .angular = {0.0, 0.0, command.yaw_rate_radps}};
}

}  // namespace

PathFollower::PathFollower(const NavigatorSettings& settings)
    : RouteFollower(settings),
      local_planner_(row_named(local_planners(), settings.local_planner.method, "navigation.local_planner.method")
                         .make(settings.local_planner)) {}

void PathFollower::set_route(const PlanResult& route, const Pose2& T_map_body) {
  path_ = PlannedPath(route.points_m);
  along_m_ = path_.project(T_map_body.position(), 0.0, path_.length_m()).along_m;
}

bool PathFollower::is_blocked_at(const Costmap& costmap, double along_m) const {
  return costmap.cost_at(path_.point_at(along_m)) == kLethalCost;
}

double PathFollower::obstacle_radius_m(const Costmap& costmap) const {
  const CostmapSettings& settings = costmap.settings();
  return costmap.footprint().inscribed_radius_m() + settings.safety_margin_m + settings.route_margin_m +
         2.0 * settings.resolution_m;
}

VelocityCommand PathFollower::command(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& last) {
  if (const std::optional<VelocityCommand> turn = turn_in_place(costmap, T_map_body, last)) return *turn;
  const double limit_mps = speed_limit_mps(costmap, T_map_body, false, remaining_m());
  return local_planner_->choose(costmap, path_, along_m_, T_map_body, twist_of(last), limit_mps)
      .value_or(VelocityCommand{});
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
