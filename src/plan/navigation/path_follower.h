#pragma once

#include <memory>
#include <optional>

#include "plan/control/local_planner.h"
#include "plan/navigation/navigator_settings.h"
#include "plan/perception/costmap.h"
#include "plan/routes/planned_path.h"

namespace patrol::plan {

/// Follows a path with the local planner: turns in place where the path leads off to the side, slows down toward its
/// end and before unmapped obstacles.
class PathFollower {
 public:
  explicit PathFollower(const NavigatorSettings& settings);

  void set_path(PlannedPath path, const Pose2& T_map_body);
  void clear() { path_ = {}; }
  const PlannedPath& path() const { return path_; }
  bool has_path() const { return !path_.is_empty(); }
  double along_m() const { return along_m_; }
  double remaining_m() const { return path_.length_m() - along_m_; }

  /// Advances along the path to the point nearest to the body; returns the distance from it.
  double advance(const Pose2& T_map_body);
  /// Whether an obstacle lies on the path within `path_check_distance_m`.
  bool is_blocked(const Costmap& costmap) const;
  /// Whether all obstacles on that part of the path have been observed for less than `new_obstacle_wait_s`.
  bool is_blocked_by_new_obstacles_only(const Costmap& costmap, Time now) const;

  /// Command of a control period. `last` is the previous command; it replaces the noisy measured twist.
  VelocityCommand command(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& last) const;

 private:
  double ahead_end_m() const;
  bool is_unmapped_obstacle_ahead(const Costmap& costmap, const Pose2& T_map_body) const;
  std::optional<VelocityCommand> turn_in_place(const Costmap& costmap, const Pose2& T_map_body,
                                               const VelocityCommand& last) const;

  NavigatorSettings settings_;
  std::unique_ptr<LocalPlanner> local_planner_;
  PlannedPath path_;
  double along_m_ = 0.0;
};

}  // namespace patrol::plan
