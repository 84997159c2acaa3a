#pragma once

#include <limits>
#include <optional>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::plan {

/// Monitors the progress of the robot: whether it leaves its position and approaches the goal.
class ProgressMonitor {
 public:
  explicit ProgressMonitor(double no_progress_timeout_s) : no_progress_timeout_s_(no_progress_timeout_s) {}

  /// Resets the monitor for another goal.
  void reset();
  /// Restarts the stuck timer at the current position: after a recovery, or while the robot waits for a route.
  void restart() { anchor_.reset(); }
  void restart_time(Time now);

  /// Whether the robot has stayed near one position for `no_progress_timeout_s`.
  bool is_stuck(Time now, const Pose2& T_map_body);
  /// Whether the remaining path is shorter than the previous minimum for this goal, by enough to count as progress.
  bool has_progressed(double remaining_m);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(anchor_, min_remaining_m_);
  }

 private:
  struct Anchor {
    Eigen::Vector2d p_map;
    Time since{};
  };

  double no_progress_timeout_s_;
  std::optional<Anchor> anchor_;
  double min_remaining_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace patrol::plan
