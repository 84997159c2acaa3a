#pragma once

#include <optional>

#include "core/messages.h"
#include "core/state/state_archive_fwd.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Interface of a recovery behavior, as in Nav2, for a robot without progress. An object is reused for all recoveries
/// of its kind.
class RecoveryBehavior {
 public:
  virtual ~RecoveryBehavior() = default;

  /// Sentence for the event log.
  virtual const char* sentence() const = 0;
  virtual void begin(Time now, const Pose2& T_map_body, Costmap& costmap) = 0;
  /// Command of a control period; none when the behavior is completed.
  virtual std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body) = 0;

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& /*archive*/) {}
};

}  // namespace patrol::plan
