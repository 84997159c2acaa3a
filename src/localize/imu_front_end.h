#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "localize/frozen_readings.h"
#include "localize/imu_calibration.h"
#include "localize/imu_mount.h"
#include "localize/motion_history.h"
#include "localize/stationary_gyro_bias.h"

namespace patrol::localize {

/// IMU front end of an odometry: checks readings, transforms them to the body origin, propagates the filter in the
/// order of the stamps, and records its motion. `Filter` is InertialFilter or TrackFilter. The odometry adds the
/// measurements of legs or tracks.
template <typename Filter>
class ImuFrontEnd {
 public:
  struct Settings {
    StationaryGyroBiasEstimator::Settings standstill;
    double buffer_s;             ///< length of the motion history
    double max_extrapolation_s;  ///< maximum time after the newest motion
  };
  /// Result of a reading: without effect; filter started; gap bridged without the reading; filter propagated by it.
  enum class Step { kIgnored, kStarted, kBridged, kPropagated };

  ImuFrontEnd(const Pose3& T_body_imu, const Settings& settings)
      : mount_(T_body_imu),
        history_(static_cast<std::size_t>(settings.buffer_s * kAssumedRate_hz)),
        bias_estimator_(settings.standstill),
        max_extrapolation_s_(settings.max_extrapolation_s) {}

  /// Returns the reading at the body origin. Returns nullopt and counts a rejection if the reading is implausible, not
  /// newer than the filter state, or frozen while the robot moves.
  std::optional<InertialSample> accept(const Imu& imu, bool is_moving) {
    Eigen::Matrix<double, 6, 1> reading;
    reading << imu.angular_velocity_radps, imu.linear_acceleration_mps2;
    if (!is_plausible(imu) || (frozen_.is_frozen(reading) && is_moving) || (filter_ && imu.stamp <= now_)) {
      reject();
      return std::nullopt;
    }
    return mount_.to_body(imu);
  }

  /// Propagates the filter to the stamp of an accepted reading. `make_filter` is called with the first reading that
  /// gives the tilt.
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
    has_timed_out_ = false;
    return step;
  }

  /// Propagates the filter to a stamp without the IMU.
  void coast_to(Time stamp, double yaw_rate_radps) {
    has_timed_out_ = true;
    bias_estimator_.reset();
    filter_->coast(to_seconds(stamp - now_), yaw_rate_radps);
    now_ = stamp;
    remember();
  }

  /// Returns whether `period` has passed since the last velocity limit, a weak measurement that keeps the
  /// velocity of the IMU alone from diverging; if so, the period starts again.
  bool is_velocity_limit_due(Time period) {
    if (now_ - last_velocity_limit_ < period) return false;
    last_velocity_limit_ = now_;
    return true;
  }

  /// Adds the motion of the filter to the history.
  void remember() { history_.push(now_, filter_->motion()); }
  void clear_history() { history_.clear(); }
  std::optional<TrunkMotion> motion_at(Time stamp) const { return history_.motion_at(stamp); }

  /// Returns the estimate at the stamp of the filter. Precondition: the filter exists.
  OdometryEstimate estimate() const {
    const TrunkMotion& motion = filter_->motion();
    return {.stamp = now_,
            .T_odom_body = motion.T_odom_body,
            .twist = {.linear = motion.v_body, .angular = motion.omega_body},
            .planar_covariance = filter_->planar_covariance()};
  }

  /// Returns the body pose at a stamp within the history or up to `max_extrapolation_s` after it; otherwise nullopt.
  std::optional<Pose3> T_odom_body_at(Time stamp) const {
    if (history_.empty()) return std::nullopt;
    if (stamp <= history_.newest()) return history_.pose_at(stamp);
    const double ahead_s = to_seconds(stamp - history_.newest());
    if (ahead_s > max_extrapolation_s_) return std::nullopt;
    // Constant horizontal velocity and yaw rate; the oscillation of the gait is not extrapolated.
    const TrunkMotion& motion = history_.newest_motion();
    const Eigen::Quaterniond& rotation = motion.T_odom_body.rotation;
    const double yaw_rate = (rotation * motion.omega_body).z();
    return Pose3{motion.T_odom_body.position + ahead_s * (rotation * motion.v_body),
                 quaternion_from_yaw(ahead_s * yaw_rate) * rotation};
  }

  /// Returns the filter; nullopt before its first reading.
  std::optional<Filter>& filter() { return filter_; }
  const std::optional<Filter>& filter() const { return filter_; }
  StationaryGyroBiasEstimator& bias_estimator() { return bias_estimator_; }
  /// Corrects the gyro bias about the vertical by a measurement, e.g. from scan matching.
  void correct_vertical_gyro_bias(double bias_radps, double std_radps) {
    if (!filter_ || !std::isfinite(bias_radps) || !(std_radps > 0.0)) return;
    const Eigen::Vector3d up = filter_->up_in_body();
    Eigen::Vector3d bias = filter_->gyro_bias_radps();
    bias.z() += (bias_radps - up.dot(bias)) / up.z();
    constexpr double kUnknown = 1e6;
    filter_->correct_gyro_bias(bias, {kUnknown, kUnknown, std_radps * std_radps});
  }
  /// Returns the biases of the IMU by the filter; empty before it exists.
  std::vector<CalibrationValue> calibration(const ImuBiasErrors& errors) const {
    if (!filter_) return {};
    constexpr int kGyro = InertialError::kGyroBias, kAccel = InertialError::kAccelBias;
    const auto& P = filter_->covariance();
    return imu_calibration({.gyro_radps = filter_->gyro_bias_radps(),
                            .accel_mps2 = filter_->accel_bias_mps2(),
                            .gyro_covariance = P.template block<3, 3>(kGyro, kGyro),
                            .accel_covariance = P.template block<3, 3>(kAccel, kAccel)},
                           errors, mount_.R_body_imu(), filter_->up_in_body());
  }
  Time now() const { return now_; }                      ///< stamp of the filter state
  bool has_timed_out() const { return has_timed_out_; }  ///< the last step of the filter was without the IMU

  void reject() { ++num_rejected_messages_; }
  std::uint64_t num_rejected_messages() const { return num_rejected_messages_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(mount_, filter_, now_, history_, bias_estimator_, last_velocity_limit_, frozen_, has_timed_out_,
            num_rejected_messages_);
  }

 private:
  static constexpr double kMaxStartAcceleration_mps2 = 1.0;        // the initial tilt is that of gravity alone
  static constexpr Time kMaxStep = std::chrono::milliseconds(50);  // a longer gap is not integrated across
  static constexpr double kAssumedRate_hz = 1000.0;                // upper bound, for the size of the history

  ImuMount mount_;
  std::optional<Filter> filter_;
  Time now_{};
  MotionHistory history_;
  StationaryGyroBiasEstimator bias_estimator_;
  double max_extrapolation_s_;
  Time last_velocity_limit_{};
  FrozenReadings<6> frozen_;
  bool has_timed_out_ = false;
  std::uint64_t num_rejected_messages_ = 0;
};

}  // namespace patrol::localize
