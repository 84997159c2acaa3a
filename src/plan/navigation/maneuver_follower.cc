#include "plan/navigation/maneuver_follower.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "plan/maneuvers/maneuver_planner.h"
#include "plan/navigation/motion_check.h"

namespace patrol::plan {
namespace {

constexpr double kCorrection_m = 0.6;     // distance over which the errors decay at low speed,
constexpr double kCorrection_s = 0.6;     // and the additional distance by the speed: steering takes time
constexpr double kSteering_s = 0.2;       // time in which the wheels turn from straight to one side
constexpr double kStop_m = 0.02;          // a stop this close to the end of a part is at its end
constexpr double kMaxLateral_mps2 = 0.8;  // lateral acceleration in curves
constexpr double kSafe_s = 0.8;           // time for which a command must be safe

/// Position of the robot relative to a pose, along the direction of travel: forward, left.
Eigen::Vector2d travel_offset(const ManeuverPose& pose, const Pose2& T_map_center) {
  const Eigen::Vector2d offset = (pose.T_map_center.inverse() * T_map_center).position();
  return pose.is_reverse ? -offset : offset;
}

}  // namespace

ManeuverFollower::ManeuverFollower(const NavigatorSettings& settings, const Pose2& T_body_center,
                                   double max_curvature_per_m)
    : RouteFollower(settings),
      T_body_center_(T_body_center),
      T_center_body_(T_body_center.inverse()),
      max_curvature_per_m_(max_curvature_per_m) {}

void ManeuverFollower::set_route(const PlanResult& route, const Pose2& T_map_body) {
  maneuver_ = route.maneuver;
  path_ = PlannedPath(route.points_m);
  next_ = std::min<std::size_t>(1, maneuver_.size() - 1);
  weights_.clear();
  advance(T_map_body);
}

void ManeuverFollower::clear() {
  RouteFollower::clear();
  maneuver_.clear();
  weights_.clear();
  next_ = 0;
}

std::size_t ManeuverFollower::end_of_part() const {
  std::size_t end = next_;
  while (end + 1 < maneuver_.size() && maneuver_[end + 1].is_reverse == maneuver_[next_].is_reverse) ++end;
  return end;
}

double ManeuverFollower::curvature_at(double along_m) const {
  const std::size_t end = end_of_part();
  std::size_t i = next_;
  while (i < end && maneuver_[i].along_m < along_m) ++i;
  return maneuver_[i].curvature_per_m;
}

double ManeuverFollower::to_stop_m() const {
  return maneuver_.empty() ? 0.0 : maneuver_[end_of_part()].along_m - along_m_;
}

bool ManeuverFollower::may_be_replaced(const Costmap& costmap) {
  constexpr double kKept_m = 2.0;
  constexpr double kMoreCost = 1.1, kMoreCost_m = 1.0;
  if (to_stop_m() <= kKept_m) return false;
  const bool is_new = weights_.empty();
  double cost_m = 0.0, planned_m = 0.0;
  for (std::size_t i = is_new ? 0 : next_; i < maneuver_.size(); ++i) {
    const double weight =
        travel_weight(costmap, maneuver_[i].T_map_center.position(), settings_.maneuver_planner.cost_weight);
    if (is_new) weights_.push_back(weight);
    if (i < next_) continue;
    if (costmap.clearance_m(maneuver_[i].T_map_center * T_center_body_) < 0.0) return true;
    const double length_m = i > 0 ? maneuver_[i].along_m - maneuver_[i - 1].along_m : 0.0;
    cost_m += length_m * weight;
    planned_m += length_m * weights_[i];
  }
  return cost_m > kMoreCost * planned_m + kMoreCost_m;
}

bool ManeuverFollower::has_ended() const {
  return maneuver_.empty() || (end_of_part() + 1 == maneuver_.size() && to_stop_m() < kStop_m);
}

/// Advances to the first pose ahead, in the present direction of travel; at the end of a part, to the next part.
double ManeuverFollower::advance(const Pose2& T_map_body) {
  if (maneuver_.empty()) return 0.0;
  const Pose2 T_map_center = T_map_body * T_body_center_;
  const std::size_t end = end_of_part();
  while (next_ < end && travel_offset(maneuver_[next_], T_map_center).x() >= 0.0) ++next_;
  Eigen::Vector2d offset = travel_offset(maneuver_[next_], T_map_center);
  if (next_ == end && end + 1 < maneuver_.size() && offset.x() > -kStop_m) {
    ++next_;
    offset = travel_offset(maneuver_[next_], T_map_center);
  }
  along_m_ = std::max(0.0, maneuver_[next_].along_m + std::min(0.0, offset.x()));
  return std::abs(offset.y());
}

VelocityCommand ManeuverFollower::command(const Costmap& costmap, const Pose2& T_map_body,
                                          const VelocityCommand& last) {
  if (maneuver_.empty() || has_ended()) return {};
  const ManeuverPose& next = maneuver_[next_];
  const Pose2 T_map_center = T_map_body * T_body_center_;
  const double lateral_m = travel_offset(next, T_map_center).y();
  const double heading_rad = wrap_angle(T_map_center.yaw - next.T_map_center.yaw);
  // The poses are at the ends of their arcs: on the way to `next`, the path still turns by this angle.
  const double turn_rad = next.curvature_per_m * (next.along_m - along_m_);
  const double correction_m = kCorrection_m + kCorrection_s * std::abs(last.vx_mps);
  const double feedback_per_m =
      -lateral_m / (correction_m * correction_m) - 2.0 * (heading_rad + turn_rad) / correction_m;
  const auto limited = [&](double curvature_per_m) {
    return std::clamp(curvature_per_m + feedback_per_m, -max_curvature_per_m_, max_curvature_per_m_);
  };
  const double curvature = limited(curvature_at(along_m_ + kSteering_s * std::abs(last.vx_mps)));
  const DwaSettings& limits = settings_.local_planner.dwa;
  const double bend_per_m = std::max(std::abs(curvature), 1e-6);
  const double top_mps = std::min({next.is_reverse ? std::max(limits.max_reverse_mps, 0.05) : limits.max_speed_mps,
                                   std::sqrt(kMaxLateral_mps2 / bend_per_m), limits.max_yaw_rate_radps / bend_per_m,
                                   speed_limit_mps(costmap, T_map_body, next.is_reverse, to_stop_m())});
  const double last_mps = next.is_reverse ? -last.vx_mps : last.vx_mps;
  const double speed_mps = std::min(top_mps, std::max(0.1, last_mps + limits.max_acceleration_mps2 * limits.window_s));
  const VelocityCommand command{.vx_mps = next.is_reverse ? -speed_mps : speed_mps,
                                .yaw_rate_radps = curvature * speed_mps};
  // Until the wheels have turned, the robot follows the present curvature. The body's origin is beside the turn center,
  // so that it also moves sideways.
  VelocityCommand motion = command;
  motion.yaw_rate_radps = limited(next.curvature_per_m) * speed_mps;
  motion.vy_mps = -T_body_center_.x * motion.yaw_rate_radps;
  // The motion ends at the next stop. On the way to a stop within the route margin it only has to be free of collision.
  const double stop_clearance_m = costmap.clearance_m(maneuver_[end_of_part()].T_map_center * T_center_body_);
  const double min_clearance_m = stop_clearance_m > costmap.settings().route_margin_m ? kMinPassable_m : 0.0;
  const double time_s = std::min(kSafe_s, to_stop_m() / speed_mps);
  return is_motion_safe(costmap, T_map_body, motion, time_s, min_clearance_m) ? command : VelocityCommand{};
}

bool ManeuverFollower::is_blocked_at(const Costmap& costmap, double along_m) const {
  const auto pose = std::find_if(maneuver_.begin(), maneuver_.end(),
                                 [along_m](const ManeuverPose& each) { return each.along_m >= along_m; });
  return pose != maneuver_.end() && costmap.clearance_m(pose->T_map_center * T_center_body_) < 0.0;
}

double ManeuverFollower::obstacle_radius_m(const Costmap& costmap) const {
  double radius_m = 0.0;
  for (const Disc& disc : costmap.footprint().discs())
    radius_m = std::max(radius_m, disc.center_m.norm() + disc.radius_m);
  return radius_m + costmap.settings().safety_margin_m;
}

}  // namespace patrol::plan
