#pragma once

#include <optional>

#include "core/messages.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Behavior of a robot that makes no progress, as in Nav2. One object serves all recoveries of its kind.
class RecoveryBehavior {
 public:
  virtual ~RecoveryBehavior() = default;

  /// One sentence for the event log.
  virtual const char* sentence() const = 0;
  virtual void begin(Time now, const Pose2& T_map_body, Costmap& costmap) = 0;
  /// Command of a control period; none when the behavior is completed.
  virtual std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body) = 0;
};

}  // namespace patrol::plan
