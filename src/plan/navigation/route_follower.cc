#include "plan/navigation/route_follower.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace patrol::plan {
namespace {

constexpr double kMinSpeed_mps = 0.15;  // minimum speed toward the end of the path

bool is_unmapped_obstacle_ahead(const NavigatorSettings& settings, const Costmap& costmap, const Pose2& T_map_body,
                                bool is_reverse) {
  if (settings.unmapped_obstacle_slowdown_distance_m <= 0.0) return false;
  const double radius_m = settings.unmapped_obstacle_slowdown_distance_m / 2.0;
  const Eigen::Vector2d ahead(is_reverse ? -radius_m : radius_m, 0.0);
  return costmap.obstacle_first_seen(T_map_body * ahead, radius_m).has_value();
}

}  // namespace

double RouteFollower::advance(const Pose2& T_map_body) {
  const PathProjection here = path_.project(T_map_body.position(), std::max(0.0, along_m_ - 0.5), along_m_ + 2.0);
  along_m_ = here.along_m;
  return here.distance_m;
}

double RouteFollower::ahead_end_m() const {
  return std::min(path_.length_m(), along_m_ + settings_.path_check_distance_m);
}

bool RouteFollower::is_blocked(const Costmap& costmap) const {
  const double to_m = ahead_end_m();
  for (double along_m = along_m_; along_m < to_m; along_m += costmap.settings().resolution_m) {
    if (is_blocked_at(costmap, along_m)) return true;
  }
  return false;
}

bool RouteFollower::is_blocked_by_new_obstacles_only(const Costmap& costmap, Time now) const {
  const double radius_m = obstacle_radius_m(costmap), to_m = ahead_end_m();
  for (double along_m = along_m_; along_m < to_m; along_m += costmap.settings().resolution_m) {
    if (!is_blocked_at(costmap, along_m)) continue;
    const std::optional<Time> since = costmap.obstacle_first_seen(path_.point_at(along_m), radius_m);
    if (!since || now - *since >= from_seconds(settings_.new_obstacle_wait_s)) return false;
  }
  return true;
}

double RouteFollower::speed_limit_mps(const Costmap& costmap, const Pose2& T_map_body, bool is_reverse,
                                      double to_stop_m) const {
  const double braking_mps = std::sqrt(2.0 * settings_.approach_deceleration_mps2 * std::max(0.0, to_stop_m));
  const double limit_mps = std::max(kMinSpeed_mps, braking_mps);
  return is_unmapped_obstacle_ahead(settings_, costmap, T_map_body, is_reverse)
             ? std::min(limit_mps, settings_.unmapped_obstacle_max_speed_mps)
             : limit_mps;
}

}  // namespace patrol::plan
