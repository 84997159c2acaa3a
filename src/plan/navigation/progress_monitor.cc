#include "plan/navigation/progress_monitor.h"

namespace patrol::plan {
namespace {

constexpr double kProgress_m = 0.5;

}  // namespace

void ProgressMonitor::reset() {
  place_.reset();
  nearest_left_m_ = std::numeric_limits<double>::infinity();
}

void ProgressMonitor::restart_time(Time now) {
  if (place_) place_->since = now;
}

bool ProgressMonitor::is_stuck(Time now, const Pose2& T_map_body) {
  if (!place_ || (T_map_body.position() - place_->p_map).norm() > kProgress_m) place_ = Place{T_map_body.position(), now};
  return now - place_->since > from_seconds(stuck_s_);
}

bool ProgressMonitor::has_come_nearer(double left_m) {
  if (left_m > nearest_left_m_ - kProgress_m) return false;
  nearest_left_m_ = left_m;
  return true;
}

}  // namespace patrol::plan
