#pragma once

#include <Eigen/Core>

#include "localize/inertial_motion.h"

namespace patrol::localize {

/// Error-state Kalman filter of a robot on tracks or on wheels that are not steered: position, attitude, velocity, gyro
/// and accelerometer bias as in InertialFilter, and the states of the track-soil interaction:
///
///   scale        relative track distance error (wear, tension): constant; positive if the encoders read too much
///   slip         longitudinal slip ratio; Gauss-Markov process over distance
///   ICR          (x, y) from the turn center of the geometry, in body, m: mean of the instantaneous centers of
///   rotation of the tracks [Mandow07], the point
///                that moves straight ahead while the body rotates; Gauss-Markov process over rotation
///
/// The tracks measure the velocity of the ICR p at ground level: v + omega x p = ((1 - scale - slip) u, 0, 0),
/// with u the mean track speed. Mecanum wheels also measure the lateral speed w: the second component is then
/// (1 - scale - slip) w. The yaw rate is that of the gyro, because the difference of the track speeds is
/// dominated by scrub. Yaw and position are not measured, and later estimates do not correct them: odom must not jump.
/// (After a kilometer a tiny change of scale would repeatedly shift the position by a centimeter.) Exception: the drift
/// of the IMU during a loss of traction is corrected.
class TrackFilter {
 public:
  struct Settings {
    double gyro_noise_density_radps_per_sqrt_hz;
    double gyro_bias_std_radps;  ///< standard deviation at power-on
    double gyro_bias_random_walk_radps_per_sqrt_s;
    double accel_noise_density_mps2_per_sqrt_hz;
    double accel_bias_std_mps2;  ///< standard deviation at power-on
    double accel_bias_random_walk_mps2_per_sqrt_s;
    double yaw_random_walk_rad_per_sqrt_rad;  ///< gyro scale factor and misalignment, during rotation
    double scale_std;
    double slip_correlation_m;         ///< correlation length of slip, in track distance
    double icr_x_std_m;                ///< longitudinal offset: lateral slip during rotation
    double icr_y_std_m;                ///< lateral offset: different traction of the two sides
    double icr_correlation_rad;        ///< correlation angle of the ICR
    double turn_center_x_m;            ///< longitudinal position of the ICR without offset, in body
    double height_m;                   ///< height of the body origin above the ground
    bool is_lateral_measured = false;  ///< mecanum wheels, which measure the lateral speed
  };

  /// Starts at the origin of odom with heading along x; tilt from gravity in the first sample.
  TrackFilter(const Settings& settings, const InertialSample& first);

  /// Predicts from the previous sample to this one.
  void predict(double dt_s, const InertialSample& sample);
  /// Predicts without IMU: velocity and tilt are constant, the yaw rate is that of the tracks.
  void coast(double dt_s, double yaw_rate_radps);

  /// Propagates slip and ICR over a track motion. `slip_std`: stationary standard deviation of slip on this
  /// ground in this maneuver.
  void propagate_slip(double distance_m, double turn_rad, double slip_std);
  /// Adds the position error across a motion in body, m, of a lateral slip with this standard deviation relative to the
  /// distance: a Gauss-Markov process over a distance that is long compared with `slip_correlation_m`.
  void add_lateral_drift(const Eigen::Vector2d& motion_m, double slip_std);
  /// Corrects with the track speed over `dt_s`, during which the body motion was `then`. `std_mps`: standard deviations
  /// of the velocity of the ICR, in body. An innovation beyond the 99.9 % bound is down-weighted instead of
  /// rejected. `lateral_mps`: lateral speed by mecanum wheels; 0 for other drives.
  void correct_speed(double dt_s, double track_mps, const TrunkMotion& then, const Eigen::Vector3d& std_mps,
                     double lateral_mps = 0.0);
  /// Corrects with a velocity estimate, when no better measurement is available.
  void correct_velocity(const Eigen::Vector3d& v_body, double std_mps);
  void correct_gyro_bias(const Eigen::Vector3d& bias_radps, const Eigen::Vector3d& variance);

  /// Starts a loss of traction: the body speed is set to the IMU estimate `forward_mps`. `position_std_m`: standard
  /// deviation of the distance error accumulated so far.
  void start_slip(double forward_mps, double position_std_m);
  /// Ends a loss of traction, at rest or at this speed, forward and lateral; resets the slip estimate.
  void end_slip(double track_mps, double slip_std, double lateral_mps = 0.0);
  /// Resets odom: its origin and x axis become those of the present pose.
  void set_origin();

  const TrunkMotion& motion() const { return motion_; }
  const Eigen::Vector3d& gyro_bias_radps() const { return gyro_bias_; }
  const Eigen::Vector3d& accel_bias_mps2() const { return accel_bias_; }
  Eigen::Vector3d up_in_body() const { return motion_.T_odom_body.rotation.conjugate() * Eigen::Vector3d::UnitZ(); }
  /// Returns the yaw rate about the z axis of odom.
  double yaw_rate_radps() const { return (motion_.T_odom_body.rotation * motion_.omega_body).z(); }
  /// Returns the IMU forward acceleration of the last step, in body, without gravity, m/s2.
  double forward_acceleration_mps2() const { return forward_acceleration_mps2_; }
  /// Returns the standard deviation of the lasting error of the forward acceleration: accelerometer bias and gravity in
  /// a wrong tilt, m/s2.
  double forward_acceleration_std_mps2() const;
  double scale() const { return scale_; }
  const Eigen::Vector2d& icr_m() const { return icr_m_; }

  /// Error covariance: rows and columns of InertialError, followed by these.
  static constexpr int kScale = InertialError::kSize, kSlip = kScale + 1, kIcr = kSlip + 1, kSize = kIcr + 2;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  const Covariance& covariance() const { return P_; }
  /// Returns the variance of the longitudinal and lateral velocity from scale, slip and ICR, (m/s)2.
  Eigen::Vector2d systematic_velocity_variance() const;
  /// Returns the covariance of x, y, yaw in odom.
  Eigen::Matrix3d planar_covariance() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(settings_, motion_, gyro_bias_, accel_bias_, scale_, slip_, icr_m_, last_, forward_acceleration_mps2_,
            pose_correction_time_s_, smooth_track_mps_, smooth_lateral_mps_, P_);
  }

 private:
  using Gain = Eigen::Matrix<double, kSize, 3>;
  void apply_error(const Eigen::Matrix<double, kSize, 1>& error);
  void apply(const Gain& W, const Eigen::Matrix3d& S, const Eigen::Vector3d& innovation);
  /// Removes the correlation of position and yaw with the other states: later corrections leave their past errors
  /// unchanged.
  void decorrelate_pose();
  /// Removes all correlations of a state and sets its variance.
  void decorrelate_state(int row, double variance);

  Settings settings_;
  TrunkMotion motion_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
  double scale_ = 0.0;
  double slip_ = 0.0;
  Eigen::Vector2d icr_m_ = Eigen::Vector2d::Zero();
  InertialSample last_;
  double forward_acceleration_mps2_ = 0.0;
  double pose_correction_time_s_ = 0.0;  ///< remaining time in which corrections also change position and yaw
  double smooth_track_mps_ = 0.0;        ///< track speed, predicted with the IMU and slowly corrected by the encoders
  double smooth_lateral_mps_ = 0.0;      ///< lateral speed by mecanum wheels, predicted and corrected like it
  Covariance P_ = Covariance::Zero();
};

}  // namespace patrol::localize
