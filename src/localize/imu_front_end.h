#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "localize/frozen_readings.h"
#include "localize/imu_mount.h"
#include "localize/motion_history.h"
#include "localize/stationary_gyro_bias.h"

namespace patrol::localize {

/// IMU side of an odometry: checks readings, takes them to the body, propagates the filter in order of stamps, and remembers its motion.
/// `Filter` is InertialFilter or TrackFilter. The odometry adds what its legs or tracks measure.
template <typename Filter>
class ImuFrontEnd {
 public:
  struct Settings {
    StationaryGyroBiasEstimator::Settings standstill;
    double buffer_s;
    double max_extrapolation_s;  ///< beyond the newest motion
  };
  /// Result of a reading: without effect; filter started; gap bridged without the reading; filter propagated by it.
  enum class Step { kIgnored, kStarted, kBridged, kPropagated };

  ImuFrontEnd(const Pose3& T_body_imu, const Settings& settings)
      : mount_(T_body_imu),
        history_(static_cast<std::size_t>(settings.buffer_s * kAssumedRate_hz)),
        bias_meter_(settings.standstill),
        max_extrapolation_s_(settings.max_extrapolation_s) {}

  /// Reading at the body's origin; none, and counted as rejected, if it is implausible, not newer than the filter's state, or frozen while the
  /// robot moves.
  std::optional<InertialSample> accept(const Imu& imu, bool is_moving) {
    Eigen::Matrix<double, 6, 1> reading;
    reading << imu.angular_velocity_radps, imu.linear_acceleration_mps2;
    if (!is_plausible(imu) || (frozen_.is_frozen(reading) && is_moving) || (filter_ && imu.stamp <= now_)) {
      reject();
      return std::nullopt;
    }
    return mount_.to_body(imu);
  }

  /// Takes the filter to the instant of an accepted reading. `make_filter` is called with the first reading from which the tilt can be read.
  template <typename MakeFilter>
  Step advance(Time stamp, const InertialSample& sample, const MakeFilter& make_filter) {
    Step step = Step::kPropagated;
    if (!filter_) {
      if (std::abs(sample.force_mps2.norm() - kGravity_mps2) > kMaxStartAcceleration_mps2) return Step::kIgnored;
      filter_.emplace(make_filter(sample));
      step = Step::kStarted;
    } else if (stamp - now_ > kMaxStep) {
      filter_->coast(to_seconds(stamp - now_), filter_->yaw_rate_radps());
      step = Step::kBridged;
    } else {
      filter_->predict(to_seconds(stamp - now_), sample);
    }
    now_ = stamp;
    is_silent_ = false;
    return step;
  }

  /// Takes the filter to an instant without the IMU.
  void coast_to(Time stamp, double yaw_rate_radps) {
    is_silent_ = true;
    bias_meter_.reset();
    filter_->coast(to_seconds(stamp - now_), yaw_rate_radps);
    now_ = stamp;
    remember();
  }

  /// Whether the filter may be told again, after `period`, that its velocity is about the last one known: without it the velocity would
  /// run away by the IMU alone.
  bool is_velocity_hold_due(Time period) {
    if (now_ - last_velocity_hold_ < period) return false;
    last_velocity_hold_ = now_;
    return true;
  }

  /// Enters the filter's motion in the history.
  void remember() { history_.push(now_, filter_->motion()); }
  void forget_history() { history_.clear(); }
  std::optional<TrunkMotion> motion_at(Time stamp) const { return history_.motion_at(stamp); }

  /// Estimate at the filter's instant; a filter must exist.
  OdometryEstimate estimate() const {
    const TrunkMotion& motion = filter_->motion();
    return {.stamp = now_,
            .T_odom_body = motion.T_odom_body,
            .twist = {.linear = motion.v_body, .angular = motion.omega_body},
            .planar_covariance = filter_->planar_covariance()};
  }

  /// Pose of the body at an instant of the history, or up to `max_extrapolation_s` after it; none outside of that.
  std::optional<Pose3> T_odom_body_at(Time stamp) const {
    if (history_.empty()) return std::nullopt;
    if (stamp <= history_.newest()) return history_.pose_at(stamp);
    const double ahead_s = to_seconds(stamp - history_.newest());
    if (ahead_s > max_extrapolation_s_) return std::nullopt;
    // Straight on, turning about the vertical: the wobble of a walk does not carry on.
    const TrunkMotion& motion = history_.newest_motion();
    const Eigen::Quaterniond& rotation = motion.T_odom_body.rotation;
    const double yaw_rate = (rotation * motion.omega_body).z();
    return Pose3{motion.T_odom_body.position + ahead_s * (rotation * motion.v_body),
                 quaternion_from_yaw(ahead_s * yaw_rate) * rotation};
  }

  /// None before the first reading that could start it.
  std::optional<Filter>& filter() { return filter_; }
  const std::optional<Filter>& filter() const { return filter_; }
  StationaryGyroBiasEstimator& bias_meter() { return bias_meter_; }
  Time now() const { return now_; }              ///< instant of the filter's state
  bool is_silent() const { return is_silent_; }  ///< the filter's last step was without the IMU

  void reject() { ++rejected_messages_; }
  std::uint64_t rejected_messages() const { return rejected_messages_; }

 private:
  static constexpr double kMaxStartAcceleration_mps2 = 1.0;  // the start's tilt is read from gravity alone
  static constexpr Time kMaxStep = std::chrono::milliseconds(50);  // a longer gap is not integrated across
  static constexpr double kAssumedRate_hz = 1000.0;                // upper bound, for the size of the history

  ImuMount mount_;
  std::optional<Filter> filter_;
  Time now_{};
  MotionHistory history_;
  StationaryGyroBiasEstimator bias_meter_;
  double max_extrapolation_s_;
  Time last_velocity_hold_{};
  FrozenReadings<6> frozen_;
  bool is_silent_ = false;
  std::uint64_t rejected_messages_ = 0;
};

}  // namespace patrol::localize
