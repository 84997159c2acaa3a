#include "localize/track_encoders.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace patrol::localize {
namespace {

constexpr Time kMaxInterval = std::chrono::milliseconds(500);  // the mean speed over a longer interval is meaningless
constexpr Time kMaxRejection = std::chrono::milliseconds(300);
// Long compared with the encoder quantization, short compared with acceleration phases.
constexpr double kSmoothing_s = 0.1;

}  // namespace

std::optional<EncoderInterval> TrackEncoders::add(const TrackTicks& ticks) {
  const std::optional<TrackTicks> before = std::exchange(last_, ticks);
  if (!before || ticks.stamp - before->stamp > kMaxInterval) {
    stationary_since_.reset();
    smooth_.reset();
    return std::nullopt;
  }
  if (ticks.left != before->left || ticks.right != before->right) {
    stationary_since_.reset();
  } else if (!stationary_since_) {
    stationary_since_ = before->stamp;
  }
  EncoderInterval interval{.start = before->stamp, .end = ticks.stamp};
  interval.step_mps = settings_.meters_per_tick / interval.dt_s();
  interval.speed = {.left_mps = interval.step_mps * static_cast<double>(ticks.left - before->left),
                    .right_mps = interval.step_mps * static_cast<double>(ticks.right - before->right)};
  if (!accept_change(interval)) return std::nullopt;

  const TrackSpeed before_mps = smooth_.value_or(interval.speed);
  const double blend = std::min(1.0, interval.dt_s() / kSmoothing_s);
  smooth_ = TrackSpeed{.left_mps = before_mps.left_mps + blend * (interval.speed.left_mps - before_mps.left_mps),
                       .right_mps = before_mps.right_mps + blend * (interval.speed.right_mps - before_mps.right_mps)};
  const double acceleration = (smooth_->mean_mps() - before_mps.mean_mps()) / interval.dt_s();
  acceleration_mps2_ += blend * (acceleration - acceleration_mps2_);
  interval.smooth = *smooth_;
  interval.acceleration_mps2 = acceleration_mps2_;
  return interval;
}

bool TrackEncoders::accept_change(const EncoderInterval& interval) {
  const double change = std::abs(interval.speed.mean_mps() - smooth_.value_or(interval.speed).mean_mps());
  const double possible = settings_.max_acceleration_mps2 * (interval.dt_s() + kSmoothing_s) + 2.0 * interval.step_mps;
  if (change <= possible) {
    rejected_since_.reset();
    return true;
  }
  if (!rejected_since_) rejected_since_ = interval.start;
  if (interval.end - *rejected_since_ < kMaxRejection) return false;
  smooth_.reset();
  rejected_since_.reset();
  return true;
}

}  // namespace patrol::localize
