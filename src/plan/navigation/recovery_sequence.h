#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plan/navigation/navigator_settings.h"
#include "plan/navigation/recovery_behavior.h"

namespace patrol::plan {

/// Recovery behavior by its name in `plan.recoveries`.
std::unique_ptr<RecoveryBehavior> make_recovery(const std::string& name, const NavigatorSettings& settings);

/// Recovery behaviors of the settings in turn, with a limit to their number without progress.
class RecoverySequence {
 public:
  /// Throws InputError if the settings name no recovery.
  explicit RecoverySequence(const NavigatorSettings& settings);

  /// Forgets all recoveries begun: another goal, or progress.
  void reset() { num_begun_ = 0; }
  /// Whether more recoveries have begun than are allowed.
  bool is_exhausted() const { return num_begun_ > max_recoveries_; }
  /// Begins the next recovery and returns its sentence.
  const char* begin_next(Time now, const Pose2& T_map_body, Costmap& costmap);
  /// Command of the recovery begun last; none when it is completed or has no room.
  std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body, const Costmap& costmap);

 private:
  std::vector<std::unique_ptr<RecoveryBehavior>> behaviors_;  ///< in order
  int max_recoveries_;
  int num_begun_ = 0;
  std::size_t active_ = 0;
};

}  // namespace patrol::plan
