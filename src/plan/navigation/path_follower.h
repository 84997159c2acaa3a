#pragma once

#include <memory>
#include <optional>

#include "plan/control/local_planner.h"
#include "plan/navigation/route_follower.h"

namespace patrol::plan {

/// Follows a path with the local planner: turns in place where the path leads off to the side, slows down toward its
/// end and before unmapped obstacles.
class PathFollower final : public RouteFollower {
 public:
  explicit PathFollower(const NavigatorSettings& settings);

  void set_route(const PlanResult& route, const Pose2& T_map_body) override;
  VelocityCommand command(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& last) override;

 private:
  bool is_blocked_at(const Costmap& costmap, double along_m) const override;
  double obstacle_radius_m(const Costmap& costmap) const override;
  std::optional<VelocityCommand> turn_in_place(const Costmap& costmap, const Pose2& T_map_body,
                                               const VelocityCommand& last) const;

  std::unique_ptr<LocalPlanner> local_planner_;
};

}  // namespace patrol::plan
