#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plan/navigation/navigator_settings.h"
#include "plan/navigation/recovery_behavior.h"

namespace patrol::plan {

/// Creates a recovery behavior by its name in `navigation.recovery.behaviors`.
std::unique_ptr<RecoveryBehavior> make_recovery(const std::string& name, const NavigatorSettings& settings);

/// Sequence of recovery behaviors from the settings, with a limit to their number without progress.
class RecoverySequence {
 public:
  /// Throws InputError if the settings name no recovery.
  explicit RecoverySequence(const NavigatorSettings& settings);

  /// Resets the count of recoveries, for another goal or after progress.
  void reset() { num_begun_ = 0; }
  /// Whether more recoveries have begun than are allowed.
  bool is_exhausted() const { return num_begun_ > max_attempts_; }
  /// Begins the next recovery and returns its sentence.
  const char* begin_next(Time now, const Pose2& T_map_body, Costmap& costmap);
  /// Command of the recovery begun last; none when it is completed or blocked.
  std::optional<VelocityCommand> step(Time now, const Pose2& T_map_body, const Costmap& costmap);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive.in_place(behaviors_);
    archive(num_begun_, active_);
  }

 private:
  std::vector<std::unique_ptr<RecoveryBehavior>> behaviors_;  ///< in order of the settings
  int max_attempts_;
  int num_begun_ = 0;
  std::size_t active_ = 0;
};

}  // namespace patrol::plan
