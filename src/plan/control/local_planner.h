#pragma once

#include <optional>

#include "core/frames.h"
#include "core/messages.h"
#include "plan/perception/costmap.h"
#include "plan/routes/planned_path.h"

namespace patrol::plan {

/// Says how to move now along a path, around what stands there.
class LocalPlanner {
 public:
  virtual ~LocalPlanner() = default;

  /// The command to give now, along the path from `along_m` on, no faster than `speed_limit_mps`. None if every arc is
  /// blocked: then the robot must stand.
  virtual std::optional<VelocityCommand> choose(const Costmap& costmap, const PlannedPath& path, double along_m,
                                                const Pose2& T_map_body, const Twist3& twist,
                                                double speed_limit_mps) const = 0;
};

}  // namespace patrol::plan
