#pragma once

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "core/state/state_archive_fwd.h"

namespace patrol::stack {

/// Monitors whether localization is lost while a mission needs the pose: the robot stands until it has relocalized, at
/// most for a timeout.
class LocalizationMonitor {
 public:
  enum class Status { kUsable, kRelocalizing, kFailed };

  explicit LocalizationMonitor(double timeout_s) : timeout_(from_seconds(timeout_s)) {}

  /// Advances by one control period. `is_lost`: localization has reported failure, and the mission needs the pose.
  /// Appends localization_lost, relocalized (value: duration, s) and localization_failed to `events`. kFailed follows
  /// after the timeout.
  Status step(Time now, bool is_lost, const Pose2& T_map_body, std::vector<Event>& events);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(lost_since_);
  }

 private:
  Time timeout_;
  std::optional<Time> lost_since_;
};

}  // namespace patrol::stack
