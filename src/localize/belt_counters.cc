#include "localize/belt_counters.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patrol::localize {
namespace {

constexpr Time kMaxInterval = std::chrono::milliseconds(500);  // the middle of a longer one says nothing
constexpr Time kDisbelief = std::chrono::milliseconds(300);
constexpr double kSmoothing_s = 0.1;  // sees the acceleration through the counters' steps

}  // namespace

std::optional<BeltInterval> BeltCounters::add(const TrackTicks& ticks) {
  const std::optional<TrackTicks> before = std::exchange(last_, ticks);
  if (!before || ticks.stamp - before->stamp > kMaxInterval) {
    stand_since_.reset();
    smooth_mps_.reset();
    return std::nullopt;
  }
  if (ticks.left != before->left || ticks.right != before->right) {
    stand_since_.reset();
  } else if (!stand_since_) {
    stand_since_ = before->stamp;
  }
  BeltInterval interval{.start = before->stamp, .end = ticks.stamp};
  interval.step_mps = settings_.metres_per_tick / interval.dt_s();
  interval.speed = {.left_mps = interval.step_mps * static_cast<double>(ticks.left - before->left),
                    .right_mps = interval.step_mps * static_cast<double>(ticks.right - before->right)};
  if (!is_believable(interval)) return std::nullopt;

  const double speed = interval.speed.mean_mps();
  const double smooth = smooth_mps_.value_or(speed);
  interval.acceleration_mps2 = (speed - smooth) / kSmoothing_s;
  smooth_mps_ = smooth + std::min(1.0, interval.dt_s() / kSmoothing_s) * (speed - smooth);
  return interval;
}

bool BeltCounters::is_believable(const BeltInterval& interval) {
  const double change = std::abs(interval.speed.mean_mps() - smooth_mps_.value_or(interval.speed.mean_mps()));
  const double possible = settings_.max_acceleration_mps2 * (interval.dt_s() + kSmoothing_s) + 2.0 * interval.step_mps;
  if (change <= possible) {
    disbelieved_since_.reset();
    return true;
  }
  if (!disbelieved_since_) disbelieved_since_ = interval.start;
  if (interval.end - *disbelieved_since_ < kDisbelief) return false;
  smooth_mps_.reset();
  disbelieved_since_.reset();
  return true;
}

}  // namespace patrol::localize
