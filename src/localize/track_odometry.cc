#include "localize/track_odometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::localize {
namespace {

constexpr Time kEncoderTimeout = std::chrono::milliseconds(200);
constexpr double kStandingStd_mps = 0.002;
constexpr double kStandstillCreep_m = 1e-5;                  // motion of the track ends over a window at rest
constexpr double kMaxBiasSigmas = 5.0;                       // a larger reading at rest is a rotation
constexpr double kTrackVelocityLimitStd_mps = 0.5;           // bound on the velocity error without encoders
constexpr double kSystematicLateral = 0.005;                 // lateral per forward velocity, straight motion
constexpr double kAgreement_mps = 0.15;                      // difference of tracks and IMU that ends slip,
constexpr Time kAgreement = std::chrono::milliseconds(300);  // and its minimum duration

const TrackOdometrySettings& checked(const TrackOdometrySettings& settings) {
  validate(settings, "odometry.tracked");
  return settings;
}

TrackFilter::Settings filter_settings(const TrackOdometrySettings& s, const RobotDescription& robot) {
  return {.gyro_noise_density_radps_per_sqrt_hz = s.gyro_noise_density_radps_per_sqrt_hz,
          .gyro_bias_std_radps = s.gyro_bias_std_radps,
          .gyro_bias_random_walk_radps_per_sqrt_s = s.gyro_bias_random_walk_radps_per_sqrt_s,
          .accel_noise_density_mps2_per_sqrt_hz = s.accel_noise_density_mps2_per_sqrt_hz,
          .accel_bias_std_mps2 = s.accel_bias_std_mps2,
          .accel_bias_random_walk_mps2_per_sqrt_s = s.accel_bias_random_walk_mps2_per_sqrt_s,
          .yaw_random_walk_rad_per_sqrt_rad = s.yaw_random_walk_rad_per_sqrt_rad,
          .scale_std = s.scale_std,
          .slip_correlation_m = s.slip_correlation_m,
          .icr_x_std_m = s.icr_x_std_m,
          .icr_y_std_m = s.icr_y_std_m,
          .icr_correlation_rad = s.icr_correlation_rad,
          .turn_center_x_m = skid_turn(robot).turn_center_x_m,
          .height_m = robot.body_height_m(),
          .is_lateral_measured = has_rollers(robot)};
}

/// Returns the four ends of the two tracks or wheel rows as stance feet. A single axle would leave the rotation about
/// it open; other points of the chassis rest as well.
StanceFeet track_ends(const DifferentialGeometry& tracks, double body_height_m) {
  StanceFeet ends;
  const double length_m = tracks.contact_length_m > 0.0 ? tracks.contact_length_m : tracks.gauge_m;
  for (int end = 0; end < kNumLegs; ++end) {
    const double x = (end < 2 ? 0.5 : -0.5) * length_m, y = (end % 2 == 0 ? 0.5 : -0.5) * tracks.gauge_m;
    ends.push_back({.leg = end, .p_contact = {x, y, -body_height_m}});
  }
  return ends;
}

}  // namespace

TrackOdometry::TrackOdometry(const RobotDescription& robot, const TrackOdometrySettings& settings)
    : robot_(robot),
      settings_(checked(settings)),
      geometry_(differential_geometry(robot)),
      skid_ratio_(settings.skid_ratio > 0.0 ? settings.skid_ratio : skid_ratio(robot)),
      is_mecanum_(has_rollers(robot)),
      meters_per_tick_(2.0 * std::numbers::pi * geometry_.rolling_radius_m / settings.ticks_per_sprocket_turn),
      track_ends_(track_ends(geometry_, robot.body_height_m())),
      imu_(robot.T_body("imu"),
           {.standstill = {.window_s = settings.standstill_window_s,
                           .gyro_noise_density_radps_per_sqrt_hz = settings.gyro_noise_density_radps_per_sqrt_hz,
                           .foot_std_m = kStandstillCreep_m},
            .buffer_s = settings.buffer_s,
            .max_extrapolation_s = settings.max_extrapolation_s}),
      rest_detector_({.window_s = settings.standstill_window_s, .max_std_mps2 = settings.standstill_accel_std_mps2}),
      slip_detector_({.window_s = settings.slip_window_s, .threshold_mps = settings.slip_disagreement_mps}),
      encoders_({.meters_per_tick = meters_per_tick_, .max_acceleration_mps2 = settings.max_track_acceleration_mps2}) {}

void TrackOdometry::add(const Imu& imu) {
  const std::optional<InertialSample> sample = imu_.accept(imu, !encoders_.is_stationary());
  if (!sample) return;
  rest_detector_.add(imu.stamp, imu.linear_acceleration_mps2);
  advance(imu.stamp, *sample);
  process_pending();
}

void TrackOdometry::add(const DriveTicks& ticks) {
  const DriveTicks* newest = !pending_.is_empty() ? &pending_.newest()
                             : encoders_.last()   ? &*encoders_.last()
                                                  : nullptr;
  if ((newest && ticks.stamp <= newest->stamp) || pending_.is_full()) {
    imu_.reject();
    return;
  }
  pending_.insert(ticks);
  process_pending();
}

void TrackOdometry::advance(Time stamp, const InertialSample& sample) {
  using Step = ImuFrontEnd<TrackFilter>::Step;
  const Time before = imu_.now();
  const auto make_filter = [this](const InertialSample& first) {
    return TrackFilter(filter_settings(settings_, robot_), first);
  };
  const Step step = imu_.advance(stamp, sample, make_filter);
  if (step == Step::kIgnored) return;
  if (step == Step::kStarted) {
    imu_.filter()->end_slip(0.0, settings_.slip_std);
    started_ = stamp;
  } else if (step == Step::kBridged) {
    slip_detector_.reset();
  } else {
    slip_detector_.add_acceleration(stamp, to_seconds(stamp - before), imu_.filter()->forward_acceleration_mps2(),
                                    imu_.filter()->forward_acceleration_std_mps2());
  }
  update_standstill(sample);
  has_settled_ = has_settled_ || to_seconds(stamp - started_) > settings_.init_timeout_s;
  imu_.remember();
  if (last_speed_update_ && encoders_timed_out()) limit_velocity();
}

// An encoder reading is due when the IMU has passed its stamp or has timed out.
void TrackOdometry::process_pending() {
  if (!imu_.filter()) {
    pending_.clear();
    return;
  }
  while (!pending_.is_empty()) {
    const DriveTicks ticks = pending_.oldest();
    if (ticks.stamp > imu_.now()) {
      if (to_seconds(pending_.newest().stamp - imu_.now()) <= settings_.imu_timeout_s) return;
      coast_to(ticks);
    }
    pending_.pop_oldest();
    use_ticks(ticks);
  }
}

void TrackOdometry::coast_to(const DriveTicks& ticks) {
  slip_detector_.reset();
  double yaw_rate = imu_.filter()->yaw_rate_radps();
  if (const std::optional<TrackSpeed> speed = encoders_.speed_until(ticks))
    yaw_rate = speed->difference_mps() / (geometry_.gauge_m * skid_ratio_);
  imu_.coast_to(ticks.stamp, yaw_rate);
}

void TrackOdometry::use_ticks(const DriveTicks& ticks) {
  const bool is_first = !encoders_.last();
  const std::optional<EncoderInterval> interval = encoders_.add(ticks);
  const std::optional<TrunkMotion> then = interval ? imu_.motion_at(interval->middle()) : std::nullopt;
  if (!then) {
    if (!is_first) imu_.reject();
    return;
  }
  if (!imu_.has_timed_out() && !update_slip_state(*interval)) return;

  const double disagreement = yaw_rate_disagreement_radps(*interval, *then);
  const double yaw_rate = std::abs(then->omega_body.z());
  const double along_mps = 0.5 * (std::abs(interval->speed.left_mps) + std::abs(interval->speed.right_mps));
  const double distance_m = is_mecanum_ ? std::hypot(along_mps, interval->speed.lateral_mps) * interval->dt_s()
                                        : along_mps * interval->dt_s();
  imu_.filter()->propagate_slip(distance_m, yaw_rate * interval->dt_s(), stationary_slip_std(yaw_rate, disagreement));
  imu_.filter()->correct_speed(interval->dt_s(), interval->speed.mean_mps(), *then,
                               speed_std(*interval, *then, disagreement), interval->speed.lateral_mps);
  if (is_mecanum_) {
    const Eigen::Vector2d motion_m =
        interval->dt_s() * Eigen::Vector2d(interval->speed.mean_mps(), interval->speed.lateral_mps);
    imu_.filter()->add_lateral_drift(motion_m, settings_.cross_slip_std);
  }
  last_speed_update_ = interval->end;
  last_speed_ = imu_.filter()->motion().v_body;
  imu_.remember();
}

double TrackOdometry::yaw_rate_disagreement_radps(const EncoderInterval& interval, const TrunkMotion& then) const {
  const double by_tracks = interval.smooth.difference_mps() / (geometry_.gauge_m * skid_ratio_);
  return std::abs(by_tracks - then.omega_body.z());
}

double TrackOdometry::stationary_slip_std(double yaw_rate_radps, double disagreement_radps) const {
  const Eigen::Vector3d up = imu_.filter()->up_in_body();
  const Eigen::Vector4d terms(settings_.slip_std, settings_.slip_std_per_radps * yaw_rate_radps,
                              settings_.slip_std_per_tilt * up.head<2>().norm(),
                              settings_.slip_std_per_disagreement * disagreement_radps);
  return terms.norm();
}

Eigen::Vector3d TrackOdometry::speed_std(const EncoderInterval& interval, const TrunkMotion& then,
                                         double disagreement_radps) const {
  if (encoders_.is_stationary()) return Eigen::Vector3d::Constant(kStandingStd_mps);
  // Quantization: uniform error of one tick at either end of the interval, two tracks.
  const double step_std = interval.step_mps / std::sqrt(12.0);
  Eigen::Matrix<double, 5, 1> along;
  along << settings_.speed_std_mps, step_std, settings_.scrub_std * interval.smooth.difference_mps(),
      settings_.acceleration_std_s * interval.acceleration_mps2, settings_.disagreement_std_m * disagreement_radps;
  const double lateral_std = std::hypot(settings_.lateral_std_mps, settings_.lateral_std_m * then.omega_body.z());
  const double residual_std = interval.smooth.residual_mps;
  if (!is_mecanum_) return {std::hypot(along.norm(), residual_std), lateral_std, settings_.vertical_std_mps};
  const Eigen::Vector4d lateral(lateral_std, step_std,
                                settings_.acceleration_std_s * interval.lateral_acceleration_mps2, residual_std);
  return {std::hypot(along.norm(), residual_std), lateral.norm(), settings_.vertical_std_mps};
}

// Loss of traction and frozen encoders are alike: the track speeds differ from the body speed. The IMU alone propagates
// the estimate until both agree for `kAgreement`, or until the body is at rest on stationary tracks. The latter ends a
// wrong detection after a stop that the accelerometer has not measured. Tracks that turn also agree with the IMU within
// the error of its speed after a bump.
bool TrackOdometry::update_slip_state(const EncoderInterval& interval) {
  const double estimated_mps = imu_.filter()->motion().v_body.x(), track_mps = interval.smooth.mean_mps();
  if (is_slipping_) {
    const bool is_stationary = encoders_.is_stationary();
    const double agreement_mps =
        is_stationary ? kAgreement_mps : std::max(kAgreement_mps, slip_detector_.roughness_bound_mps());
    if (std::abs(track_mps - estimated_mps) > agreement_mps) agree_since_.reset();
    else if (!agree_since_) agree_since_ = interval.start;
    const bool is_at_rest = is_stationary && rest_detector_.is_at_rest();
    if (is_at_rest) imu_.filter()->correct_velocity(Eigen::Vector3d::Zero(), kStandingStd_mps);
    else if (!agree_since_ || interval.end - *agree_since_ < kAgreement) return false;
    is_slipping_ = false;
    slip_detector_.reset();
    imu_.filter()->end_slip(track_mps, settings_.slip_std, interval.smooth.lateral_mps);
  }
  const auto evidence = slip_detector_.add_speed(interval.end, interval.speed.mean_mps(), estimated_mps);
  if (!evidence) return true;
  ++num_slip_events_;
  is_slipping_ = true;
  agree_since_.reset();
  imu_.filter()->start_slip(evidence->forward_mps, 0.5 * std::abs(evidence->disagreement_mps) * evidence->duration_s);
  last_speed_ = imu_.filter()->motion().v_body;
  imu_.remember();
  return false;
}

void TrackOdometry::update_standstill(const InertialSample& sample) {
  if (!encoders_.is_stationary() || is_slipping_) {
    imu_.bias_estimator().reset();
    return;
  }
  const auto reading = imu_.bias_estimator().add(imu_.now(), track_ends_, sample.rate_radps);
  if (!reading) return;
  if (reading->bias_radps.cwiseAbs().maxCoeff() > kMaxBiasSigmas * settings_.gyro_bias_std_radps) return;
  imu_.filter()->correct_gyro_bias(reading->bias_radps, reading->variance);
  imu_.filter()->end_slip(0.0, settings_.slip_std);
  if (has_settled_ || to_seconds(imu_.now() - encoders_.stationary_since()) < settings_.settling_time_s) return;
  imu_.filter()->set_origin();
  imu_.clear_history();
  has_settled_ = true;
}

// The velocity of the IMU alone diverges; it stays near that of the last encoder reading.
void TrackOdometry::limit_velocity() {
  if (!imu_.is_velocity_limit_due(kEncoderTimeout)) return;
  imu_.filter()->correct_velocity(last_speed_, kTrackVelocityLimitStd_mps);
  imu_.remember();
}

std::optional<OdometryEstimate> TrackOdometry::estimate() const {
  if (!has_settled_ || !last_speed_update_) return std::nullopt;
  return imu_.estimate();
}

std::optional<Pose3> TrackOdometry::T_odom_body_at(Time stamp) const {
  if (!estimate()) return std::nullopt;
  return imu_.T_odom_body_at(stamp);
}

// With encoder readings, fast velocity errors (quantization, vibration) average out within a tenth of a second. The
// systematic errors are slip and ICR, unless the IMU constrains them.
Eigen::Vector3d TrackOdometry::twist_std() const {
  if (!imu_.filter()) return Eigen::Vector3d::Zero();
  constexpr int kVelocity = InertialError::kVelocity, kBias = InertialError::kGyroBias + 2;
  const auto& P = imu_.filter()->covariance();
  Eigen::Vector2d variance = P.diagonal().segment<2>(kVelocity);
  if (!encoders_timed_out()) variance = variance.cwiseMin(imu_.filter()->systematic_velocity_variance());
  const Eigen::Vector3d& v = imu_.filter()->motion().v_body;
  if (is_mecanum_) {
    return {std::hypot(std::sqrt(variance.x()), settings_.cross_slip_std * v.y()),
            std::hypot(std::sqrt(variance.y()), settings_.cross_slip_std * v.x()), std::sqrt(P(kBias, kBias))};
  }
  const double lateral_mps = kSystematicLateral * v.x();
  return {std::sqrt(variance.x()), std::hypot(std::sqrt(variance.y()), lateral_mps), std::sqrt(P(kBias, kBias))};
}

bool TrackOdometry::encoders_timed_out() const {
  return !last_speed_update_ || imu_.now() - *last_speed_update_ > kEncoderTimeout;
}

std::vector<CalibrationValue> TrackOdometry::calibration() const {
  std::vector<CalibrationValue> values = imu_.calibration({.accel_filter_prior_std_mps2 = settings_.accel_bias_std_mps2,
                                                           .accel_prior_std_mps2 = settings_.accel_bias_std_mps2,
                                                           .accel_scale_std = settings_.accel_scale_std});
  if (!imu_.filter()) return values;
  const TrackFilter& filter = *imu_.filter();
  constexpr int kIcr = TrackFilter::kIcr;
  const auto add = [&](CalibrationParameter parameter, double value, double variance) {
    values.push_back({.name = std::string(name_of(parameter)), .value = value, .std = std::sqrt(variance)});
  };
  add(CalibrationParameter::kTurnCenterX, filter.icr_m().x(), filter.covariance()(kIcr, kIcr));
  add(CalibrationParameter::kTurnCenterY, filter.icr_m().y(), filter.covariance()(kIcr + 1, kIcr + 1));
  return values;
}

TrackOdometryHealth TrackOdometry::health() const {
  TrackOdometryHealth health{.imu_timed_out = imu_.has_timed_out(),
                             .is_slipping = is_slipping_,
                             .num_rejected_messages = imu_.num_rejected_messages(),
                             .num_slip_events = num_slip_events_};
  health.encoders_timed_out = encoders_timed_out();
  if (!imu_.filter()) return health;
  health.gyro_z_bias_std_radps = twist_std().z();
  return health;
}

}  // namespace patrol::localize
