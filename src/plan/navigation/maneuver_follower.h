#pragma once

#include <cstddef>
#include <vector>

#include "plan/navigation/route_follower.h"
#include "plan/routes/maneuver.h"

namespace patrol::plan {

/// Follows a maneuver of a robot that cannot turn in place: steers by the lateral and the heading error of the turn
/// center, and stops where the direction of travel changes.
///
/// Along the direction of travel, with the lateral error e and the heading error a of a robot on a path of curvature c,
/// the commanded curvature is c - e / L^2 - 2 a / L: both errors decay over the distance L without oscillation. c is
/// that of the path 0.2 s ahead, because the wheels take time to turn.
class ManeuverFollower final : public RouteFollower {
 public:
  /// `T_body_center`: turn center in body. `max_curvature_per_m`: of the robot.
  ManeuverFollower(const NavigatorSettings& settings, const Pose2& T_body_center, double max_curvature_per_m);

  void set_route(const PlanResult& route, const Pose2& T_map_body) override;
  void clear() override;
  double advance(const Pose2& T_map_body) override;
  /// The last two meters before a stop are driven to the end: a new maneuver would begin with another correction.
  /// Before, a maneuver is replaced only if its rest has become blocked or costs at least a tenth more: searches are
  /// expensive.
  bool may_be_replaced(const Costmap& costmap) override;
  bool has_ended() const override;
  VelocityCommand command(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& last) override;
  void serialize_state(StateArchive& archive) override;

 private:
  bool is_blocked_at(const Costmap& costmap, double along_m) const override;
  double obstacle_radius_m(const Costmap& costmap) const override;
  /// Returns the index of the last pose with the present direction of travel.
  std::size_t end_of_part() const;
  /// Returns the curvature of the maneuver at a distance along it, at most at the end of the present part.
  double curvature_at(double along_m) const;
  double to_stop_m() const;

  Pose2 T_body_center_, T_center_body_;
  double max_curvature_per_m_;
  Maneuver maneuver_;
  std::size_t next_ = 0;         ///< index of the next pose to reach
  std::vector<double> weights_;  ///< cost of a meter when the maneuver was new, [pose]; empty until then
};

}  // namespace patrol::plan
