#include "plan/navigation/progress_monitor.h"

namespace patrol::plan {
namespace {

constexpr double kProgress_m = 0.5;

}  // namespace

void ProgressMonitor::reset() {
  anchor_.reset();
  min_remaining_m_ = std::numeric_limits<double>::infinity();
}

void ProgressMonitor::restart_time(Time now) {
  if (anchor_) anchor_->since = now;
}

bool ProgressMonitor::is_stuck(Time now, const Pose2& T_map_body) {
  if (!anchor_ || (T_map_body.position() - anchor_->p_map).norm() > kProgress_m)
    anchor_ = Anchor{T_map_body.position(), now};
  return now - anchor_->since > from_seconds(no_progress_timeout_s_);
}

bool ProgressMonitor::has_progressed(double remaining_m) {
  if (remaining_m > min_remaining_m_ - kProgress_m) return false;
  min_remaining_m_ = remaining_m;
  return true;
}

}  // namespace patrol::plan
