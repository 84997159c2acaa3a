#pragma once

#include "plan/navigation/recovery_behavior.h"

namespace patrol::plan {

/// Clears the obstacles around the robot; later messages mark those that are still observed.
void clear_around(Costmap& costmap, const Pose2& T_map_body);

/// Recovery that only clears the costmap around the robot.
class ClearCostmap : public RecoveryBehavior {
 public:
  const char* sentence() const override { return "Recovery: clearing the local costmap."; }
  void begin(Time now, const Pose2& T_map_body, Costmap& costmap) override;
  std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body) override;
};

}  // namespace patrol::plan
