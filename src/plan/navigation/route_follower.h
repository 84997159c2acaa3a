#pragma once

#include "core/messages.h"
#include "core/state/state_archive_fwd.h"
#include "plan/navigation/navigator_settings.h"
#include "plan/perception/costmap.h"
#include "plan/routes/global_planner.h"
#include "plan/routes/planned_path.h"

namespace patrol::plan {

/// Interface of a follower of a planned route, with the checks of the route ahead.
class RouteFollower {
 public:
  explicit RouteFollower(const NavigatorSettings& settings) : settings_(settings) {}
  virtual ~RouteFollower() = default;

  virtual void set_route(const PlanResult& route, const Pose2& T_map_body) = 0;
  virtual void clear() { path_ = {}; }
  const PlannedPath& path() const { return path_; }
  bool has_path() const { return !path_.is_empty(); }
  double along_m() const { return along_m_; }
  double remaining_m() const { return path_.length_m() - along_m_; }

  /// Advances along the path to the point nearest to the body; returns the distance from it.
  virtual double advance(const Pose2& T_map_body);
  /// Whether an obstacle lies on the path within `path_check_distance_m`.
  bool is_blocked(const Costmap& costmap) const;
  /// Whether all obstacles on that part of the path have been observed for less than `new_obstacle_wait_s`.
  bool is_blocked_by_new_obstacles_only(const Costmap& costmap, Time now) const;
  /// Whether a changed map may replace the route.
  virtual bool may_be_replaced(const Costmap& /*costmap*/) { return true; }
  /// Whether the route has ended, although the robot is not at the goal.
  virtual bool has_ended() const { return false; }

  /// Command of a control period. `last` is the previous command; it replaces the noisy measured twist.
  virtual VelocityCommand command(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& last) = 0;

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& archive);

 protected:
  virtual bool is_blocked_at(const Costmap& costmap, double along_m) const = 0;
  /// Radius around a blocked point of the path in which its obstacles are.
  virtual double obstacle_radius_m(const Costmap& costmap) const = 0;
  /// Speed limit at a distance from a stop, and before an unmapped obstacle.
  double speed_limit_mps(const Costmap& costmap, const Pose2& T_map_body, bool is_reverse, double to_stop_m) const;

  NavigatorSettings settings_;
  PlannedPath path_;
  double along_m_ = 0.0;

 private:
  double ahead_end_m() const;
};

}  // namespace patrol::plan
