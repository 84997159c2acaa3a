#include "localize/track_filter.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/LU>

namespace patrol::localize {
namespace {

using Error = InertialError;

constexpr double kTrackStartTiltStd_rad = 0.05;
constexpr double kTrackStartVelocityStd_mps = 0.05;
constexpr double kTrackGate = 16.27;  // 99.9 % of chi-square, three degrees of freedom
constexpr double kLostSpeedStd_mps = 0.1;
constexpr double kTrackSmoothing_s = 1.0;
constexpr double kPoseCorrectionTime_s =
    0.5;  // after a loss of traction; the first readings contain nearly all information
constexpr int kPoseRows[4] = {Error::kPosition, Error::kPosition + 1, Error::kPosition + 2, Error::kRotation + 2};
// Process noise without an IMU.
constexpr double kTrackCoastYawRateStd = 0.05;  // rad/sqrt(s): yaw rate from the tracks
constexpr double kTrackCoastTiltStd = 0.03;     // rad/sqrt(s)
constexpr double kTrackCoastVelocityStd = 1.0;  // m/s/sqrt(s)

}  // namespace

TrackFilter::TrackFilter(const Settings& settings, const InertialSample& first) : settings_(settings), last_(first) {
  motion_.T_odom_body.rotation = tilt_from_gravity(first.force_mps2);
  motion_.omega_body = first.rate_radps;
  const auto set_std = [this](int block, double std) { P_.diagonal().segment<3>(block).setConstant(std * std); };
  set_std(Error::kRotation, kTrackStartTiltStd_rad);
  P_(Error::kRotation + 2, Error::kRotation + 2) = 0.0;  // odom is where it started
  set_std(Error::kVelocity, kTrackStartVelocityStd_mps);
  set_std(Error::kGyroBias, settings.gyro_bias_std_radps);
  set_std(Error::kAccelBias, settings.accel_bias_std_mps2);
  correlate_start_tilt(P_, motion_.T_odom_body.rotation);
  P_(kScale, kScale) = std::pow(settings.scale_std, 2);
  P_(kIcr, kIcr) = std::pow(settings.icr_x_std_m, 2);
  P_(kIcr + 1, kIcr + 1) = std::pow(settings.icr_y_std_m, 2);
}

void TrackFilter::predict(double dt_s, const InertialSample& sample) {
  // Trapezoidal rule: the mean of the previous sample and this one applies to the step.
  const Eigen::Vector3d omega = 0.5 * (last_.rate_radps + sample.rate_radps) - gyro_bias_;
  const Eigen::Vector3d force = 0.5 * (last_.force_mps2 + sample.force_mps2) - accel_bias_;
  last_ = sample;

  const InertialStep step = integrate(motion_, dt_s, omega, force);
  forward_acceleration_mps2_ = (step.after.v_body - motion_.v_body).x() / dt_s;
  smooth_track_mps_ += dt_s * forward_acceleration_mps2_;
  if (settings_.is_lateral_measured) smooth_lateral_mps_ += (step.after.v_body - motion_.v_body).y();
  motion_ = step.after;
  motion_.omega_body = sample.rate_radps - gyro_bias_;

  propagate_inertial_errors(P_, dt_s, step.R_odom_body, step.v_body, omega);
  const auto add_noise = [&](int block, double density) {
    P_.diagonal().segment<3>(block).array() += dt_s * density * density;
  };
  add_noise(Error::kRotation, settings_.gyro_noise_density_radps_per_sqrt_hz);
  add_noise(Error::kVelocity, settings_.accel_noise_density_mps2_per_sqrt_hz);
  add_noise(Error::kGyroBias, settings_.gyro_bias_random_walk_radps_per_sqrt_s);
  add_noise(Error::kAccelBias, settings_.accel_bias_random_walk_mps2_per_sqrt_s);
  P_(Error::kRotation + 2, Error::kRotation + 2) +=
      dt_s * std::abs(omega.z()) * std::pow(settings_.yaw_random_walk_rad_per_sqrt_rad, 2);
}

void TrackFilter::coast(double dt_s, double yaw_rate_radps) {
  Pose3& T = motion_.T_odom_body;
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  T.position += dt_s * (R * motion_.v_body);
  T.rotation = (quaternion_from_yaw(dt_s * yaw_rate_radps) * T.rotation).normalized();
  motion_.omega_body = R.transpose() * Eigen::Vector3d(0.0, 0.0, yaw_rate_radps);
  last_ = {motion_.omega_body + gyro_bias_, kGravity_mps2 * R.transpose().col(2) + accel_bias_};
  forward_acceleration_mps2_ = 0.0;

  propagate_inertial_errors(P_, dt_s, R, motion_.v_body, motion_.omega_body);
  P_.diagonal().segment<2>(Error::kRotation).array() += dt_s * kTrackCoastTiltStd * kTrackCoastTiltStd;
  P_(Error::kRotation + 2, Error::kRotation + 2) += dt_s * kTrackCoastYawRateStd * kTrackCoastYawRateStd;
  P_.diagonal().segment<3>(Error::kVelocity).array() += dt_s * kTrackCoastVelocityStd * kTrackCoastVelocityStd;
}

// First-order Gauss-Markov process: the value decays by a, and (1 - a^2) of the stationary variance is added.
void TrackFilter::propagate_slip(double distance_m, double turn_rad, double slip_std) {
  const auto decay = [this](int row, double& value, double a, double std) {
    value *= a;
    P_.row(row) *= a;
    P_.col(row) *= a;
    P_(row, row) += (1.0 - a * a) * std * std;
  };
  decay(kSlip, slip_, std::exp(-distance_m / settings_.slip_correlation_m), slip_std);
  const double a_turn = std::exp(-turn_rad / settings_.icr_correlation_rad);
  decay(kIcr, icr_m_.x(), a_turn, settings_.icr_x_std_m);
  decay(kIcr + 1, icr_m_.y(), a_turn, settings_.icr_y_std_m);
}

// The variance of the integral of a Gauss-Markov process with the variance s^2 and the correlation length L grows with
// 2 s^2 L per distance.
void TrackFilter::add_lateral_drift(const Eigen::Vector2d& motion_m, double slip_std) {
  const double distance_m = motion_m.norm();
  if (distance_m <= 0.0) return;
  const Eigen::Vector3d left = motion_.T_odom_body.rotation * Eigen::Vector3d(-motion_m.y(), motion_m.x(), 0.0);
  P_.block<3, 3>(Error::kPosition, Error::kPosition) +=
      2.0 * slip_std * slip_std * settings_.slip_correlation_m / distance_m * left * left.transpose();
}

// With p = p_true - dp, omega = omega_true + dbg and s = scale + slip = s_true - ds, the innovation
// ((1 - s) u, (1 - s) w, 0) - v - omega x p is dv + [p]x dbg + [omega]x dp + (u, w, 0) ds + noise. Only mecanum wheels
// have a lateral speed w.
//
// The speed u that multiplies slip must not share the noise of the reading. Encoder steps of 1 to 2 mm would otherwise
// bias the scale by several percent. It is therefore smoothed over one second and predicted with the IMU in between.
void TrackFilter::correct_speed(double dt_s, double track_mps, const TrunkMotion& then, const Eigen::Vector3d& std_mps,
                                double lateral_mps) {
  if (settings_.is_lateral_measured)
    smooth_lateral_mps_ += std::min(1.0, dt_s / kTrackSmoothing_s) * (lateral_mps - smooth_lateral_mps_);
  smooth_track_mps_ += std::min(1.0, dt_s / kTrackSmoothing_s) * (track_mps - smooth_track_mps_);
  const Eigen::Vector3d p(settings_.turn_center_x_m + icr_m_.x(), icr_m_.y(), -settings_.height_m);
  const Eigen::Vector3d innovation = Eigen::Vector3d(track_mps - (scale_ + slip_) * smooth_track_mps_,
                                                     lateral_mps - (scale_ + slip_) * smooth_lateral_mps_, 0.0) -
                                     then.v_body - then.omega_body.cross(p);

  Eigen::Matrix<double, 3, kSize> H = Eigen::Matrix<double, 3, kSize>::Zero();
  H.middleCols<3>(Error::kVelocity).setIdentity();
  H.middleCols<3>(Error::kGyroBias) = cross_matrix(p);
  H(0, kScale) = H(0, kSlip) = smooth_track_mps_;
  H(1, kScale) = H(1, kSlip) = smooth_lateral_mps_;
  H.middleCols<2>(kIcr) = cross_matrix(then.omega_body).leftCols<2>();

  const Gain W = P_ * H.transpose();
  Eigen::Matrix3d S = H * W;
  S.diagonal().array() += std_mps.array().square();
  const double distance = innovation.dot(S.inverse() * innovation);
  if (distance > kTrackGate) S.diagonal().array() += std_mps.array().square() * (distance / kTrackGate - 1.0);
  apply(W, S, innovation);
  pose_correction_time_s_ = std::max(0.0, pose_correction_time_s_ - dt_s);
}

void TrackFilter::correct_velocity(const Eigen::Vector3d& v_body, double std_mps) {
  const Gain W = P_.middleCols<3>(Error::kVelocity);
  Eigen::Matrix3d S = W.middleRows<3>(Error::kVelocity);
  S.diagonal().array() += std_mps * std_mps;
  apply(W, S, v_body - motion_.v_body);
}

void TrackFilter::correct_gyro_bias(const Eigen::Vector3d& bias_radps, const Eigen::Vector3d& variance) {
  const Gain W = P_.middleCols<3>(Error::kGyroBias);
  Eigen::Matrix3d S = W.middleRows<3>(Error::kGyroBias);
  S.diagonal() += variance;
  apply(W, S, bias_radps - gyro_bias_);
}

void TrackFilter::start_slip(double forward_mps, double position_std_m) {
  motion_.v_body.x() = forward_mps;
  decorrelate_pose();
  pose_correction_time_s_ = std::numeric_limits<double>::infinity();
  P_(Error::kVelocity, Error::kVelocity) += kLostSpeedStd_mps * kLostSpeedStd_mps;
  const Eigen::Vector3d along = motion_.T_odom_body.rotation * Eigen::Vector3d(position_std_m, 0.0, 0.0);
  P_.block<3, 3>(Error::kPosition, Error::kPosition) += along * along.transpose();
}

void TrackFilter::end_slip(double track_mps, double slip_std, double lateral_mps) {
  pose_correction_time_s_ = std::min(pose_correction_time_s_, kPoseCorrectionTime_s);
  smooth_track_mps_ = track_mps;
  smooth_lateral_mps_ = lateral_mps;
  slip_ = 0.0;
  decorrelate_state(kSlip, slip_std * slip_std);
}

void TrackFilter::decorrelate_state(int row, double variance) {
  P_.row(row).setZero();
  P_.col(row).setZero();
  P_(row, row) = variance;
}

void TrackFilter::set_origin() {
  Pose3& T = motion_.T_odom_body;
  const Eigen::Quaterniond turn_back = quaternion_from_yaw(-to_yaw(T.rotation));
  T.position.setZero();
  T.rotation = (turn_back * T.rotation).normalized();
  const Eigen::Matrix3d R = turn_back.toRotationMatrix();
  P_.middleRows<3>(Error::kRotation) = (R * P_.middleRows<3>(Error::kRotation)).eval();
  P_.middleCols<3>(Error::kRotation) = (P_.middleCols<3>(Error::kRotation) * R.transpose()).eval();
  for (const int row : kPoseRows) decorrelate_state(row, 0.0);
}

// With rows of the gain set to zero, the covariance update has Joseph's form (Schmidt's consider update).
void TrackFilter::apply(const Gain& W, const Eigen::Matrix3d& S, const Eigen::Vector3d& innovation) {
  Gain K = W * S.inverse();
  if (pose_correction_time_s_ <= 0.0) {
    for (const int row : kPoseRows) K.row(row).setZero();
  }
  apply_error(K * innovation);
  P_ += K * S * K.transpose() - K * W.transpose() - W * K.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

void TrackFilter::decorrelate_pose() {
  constexpr std::size_t kRows = std::size(kPoseRows);
  Eigen::Matrix<double, kRows, kRows> pose_block;
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t k = 0; k < kRows; ++k) pose_block(i, k) = P_(kPoseRows[i], kPoseRows[k]);
  }
  for (const int row : kPoseRows) decorrelate_state(row, 0.0);
  for (std::size_t i = 0; i < kRows; ++i) {
    for (std::size_t k = 0; k < kRows; ++k) P_(kPoseRows[i], kPoseRows[k]) = pose_block(i, k);
  }
}

void TrackFilter::apply_error(const Eigen::Matrix<double, kSize, 1>& error) {
  Pose3& T = motion_.T_odom_body;
  T.position += error.segment<3>(Error::kPosition);
  T.rotation = (rotation_by(error.segment<3>(Error::kRotation)) * T.rotation).normalized();
  motion_.v_body += error.segment<3>(Error::kVelocity);
  gyro_bias_ += error.segment<3>(Error::kGyroBias);
  accel_bias_ += error.segment<3>(Error::kAccelBias);
  motion_.omega_body -= error.segment<3>(Error::kGyroBias);
  scale_ += error[kScale];
  slip_ += error[kSlip];
  icr_m_ += error.segment<2>(kIcr);
}

// v = (1 - scale - slip) (u, w) - omega x p
double TrackFilter::forward_acceleration_std_mps2() const {
  const Eigen::Matrix3d R = motion_.T_odom_body.rotation.toRotationMatrix();
  const Eigen::Matrix3d by_rotation = R.transpose() * cross_matrix(Eigen::Vector3d(0.0, 0.0, -kGravity_mps2));
  Eigen::Matrix<double, 1, 6> H;
  H << by_rotation.row(0), -Eigen::RowVector3d::UnitX();
  Eigen::Matrix<double, 6, 6> P;
  constexpr int kRotation = Error::kRotation, kBias = Error::kAccelBias;
  P << P_.block<3, 3>(kRotation, kRotation), P_.block<3, 3>(kRotation, kBias), P_.block<3, 3>(kBias, kRotation),
      P_.block<3, 3>(kBias, kBias);
  return std::sqrt(std::max(0.0, (H * P * H.transpose()).value()));
}

Eigen::Vector2d TrackFilter::systematic_velocity_variance() const {
  const double u = smooth_track_mps_, w = smooth_lateral_mps_, omega = motion_.omega_body.z();
  const Eigen::Vector4d ahead(-u, -u, 0.0, omega), left(-w, -w, -omega, 0.0);
  const Eigen::Matrix4d P = P_.bottomRightCorner<4, 4>();
  return {ahead.dot(P * ahead), left.dot(P * left)};
}

Eigen::Matrix3d TrackFilter::planar_covariance() const {
  constexpr int kIndex[3] = {Error::kPosition, Error::kPosition + 1, Error::kRotation + 2};
  Eigen::Matrix3d planar;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) planar(row, col) = P_(kIndex[row], kIndex[col]);
  }
  return planar;
}

}  // namespace patrol::localize
