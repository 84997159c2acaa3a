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

std::optional<EncoderInterval> TrackEncoders::add(const DriveTicks& ticks) {
  const std::optional<DriveTicks> before = std::exchange(last_, ticks);
  if (!before || ticks.stamp - before->stamp > kMaxInterval) {
    stationary_since_.reset();
    smooth_.reset();
    return std::nullopt;
  }
  if (ticks.left != before->left || ticks.right != before->right || ticks.lateral != before->lateral ||
      ticks.residual != before->residual) {
    stationary_since_.reset();
  } else if (!stationary_since_) {
    stationary_since_ = before->stamp;
  }
  EncoderInterval interval = interval_from(*before, ticks);
  if (!accept_change(interval)) return std::nullopt;

  const TrackSpeed before_mps = smooth_.value_or(interval.speed);
  const double blend = std::min(1.0, interval.dt_s() / kSmoothing_s);
  const auto blended = [&](double TrackSpeed::*part) {
    return before_mps.*part + blend * (interval.speed.*part - before_mps.*part);
  };
  smooth_ = TrackSpeed{.left_mps = blended(&TrackSpeed::left_mps),
                       .right_mps = blended(&TrackSpeed::right_mps),
                       .lateral_mps = blended(&TrackSpeed::lateral_mps),
                       .residual_mps = blended(&TrackSpeed::residual_mps)};
  const double acceleration = (smooth_->mean_mps() - before_mps.mean_mps()) / interval.dt_s();
  acceleration_mps2_ += blend * (acceleration - acceleration_mps2_);
  const double lateral = (smooth_->lateral_mps - before_mps.lateral_mps) / interval.dt_s();
  lateral_acceleration_mps2_ += blend * (lateral - lateral_acceleration_mps2_);
  interval.smooth = *smooth_;
  interval.acceleration_mps2 = acceleration_mps2_;
  interval.lateral_acceleration_mps2 = lateral_acceleration_mps2_;
  return interval;
}

EncoderInterval TrackEncoders::interval_from(const DriveTicks& before, const DriveTicks& ticks) const {
  EncoderInterval interval{.start = before.stamp, .end = ticks.stamp};
  interval.step_mps = settings_.meters_per_tick / interval.dt_s();
  interval.speed = {.left_mps = interval.step_mps * static_cast<double>(ticks.left - before.left),
                    .right_mps = interval.step_mps * static_cast<double>(ticks.right - before.right),
                    .lateral_mps = interval.step_mps * static_cast<double>(ticks.lateral - before.lateral),
                    .residual_mps = interval.step_mps * static_cast<double>(ticks.residual - before.residual)};
  return interval;
}

std::optional<TrackSpeed> TrackEncoders::speed_until(const DriveTicks& ticks) const {
  if (!last_) return std::nullopt;
  const EncoderInterval interval = interval_from(*last_, ticks);
  const TrackSpeed before_mps = smooth_.value_or(interval.speed);
  const double change = std::max(std::abs(interval.speed.left_mps - before_mps.left_mps),
                                 std::abs(interval.speed.right_mps - before_mps.right_mps));
  return change <= max_change_mps(interval) ? std::optional(interval.speed) : std::nullopt;
}

double TrackEncoders::max_change_mps(const EncoderInterval& interval) const {
  return settings_.max_acceleration_mps2 * (interval.dt_s() + kSmoothing_s) + 2.0 * interval.step_mps;
}

bool TrackEncoders::accept_change(const EncoderInterval& interval) {
  const TrackSpeed before_mps = smooth_.value_or(interval.speed);
  const double change = std::hypot(interval.speed.mean_mps() - before_mps.mean_mps(),
                                   interval.speed.lateral_mps - before_mps.lateral_mps);
  if (change <= max_change_mps(interval)) {
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
