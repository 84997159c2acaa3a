#pragma once

#include <optional>
#include <vector>

#include "core/settings.h"
#include "plan/control/dwa_settings.h"
#include "plan/control/local_planner.h"
#include "plan/control/rollouts/clearance.h"
#include "plan/control/rollouts/command_change.h"
#include "plan/control/rollouts/path_distance.h"
#include "plan/control/rollouts/path_heading.h"
#include "plan/control/rollouts/progress.h"
#include "plan/control/rollouts/rollout.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Local planner by the dynamic window approach [Fox97]. Of the commands reachable within `window_s` it chooses the one
/// whose constant-velocity arc has the minimum cost. An arc without positive clearance is rejected, unless the robot
/// is already in collision and the arc leads away from the obstacle. With `max_lateral_speed_mps` the commands also
/// have a lateral speed.
class DynamicWindow final : public LocalPlanner {
 public:
  explicit DynamicWindow(const DwaSettings& settings);

  std::optional<VelocityCommand> choose(const Costmap& costmap, const PlannedPath& path, double along_m,
                                        const Pose2& T_map_body, const Twist3& twist,
                                        double speed_limit_mps) const override;

 private:
  std::vector<double> reachable_lateral_speeds(double lateral_mps) const;
  double cost(const Rollout& rollout, const RolloutScene& scene) const;

  DwaSettings settings_;
  PathDistanceCost path_distance_;
  ProgressCost progress_;
  PathHeadingCost heading_;
  ClearanceCost clearance_;
  CommandChangeCost change_;
};

}  // namespace patrol::plan
