#pragma once

#include <optional>

#include "core/frames.h"
#include "core/messages.h"
#include "plan/perception/costmap.h"
#include "plan/routes/planned_path.h"

namespace patrol::plan {

/// Interface of a local planner: velocity commands along a path, around obstacles of the costmap.
class LocalPlanner {
 public:
  virtual ~LocalPlanner() = default;

  /// Command along the path from `along_m` on, at most `speed_limit_mps` fast. None if every arc is blocked: then the
  /// robot must stop.
  virtual std::optional<VelocityCommand> choose(const Costmap& costmap, const PlannedPath& path, double along_m,
                                                const Pose2& T_map_body, const Twist3& twist,
                                                double speed_limit_mps) const = 0;
};

}  // namespace patrol::plan
