#pragma once

#include <Eigen/Core>

#include "localize/inertial_motion.h"

namespace patrol::localize {

/// Error-state Kalman filter of a tracked body: position, attitude, velocity, gyro and accelerometer bias, as InertialFilter, and
/// what lies between the belts and the ground:
///
///   scale        of the belts (wear, tension): constant, the share by which they seem to go too far
///   slip         share of the belts' way that the ground does not give back; wanders with the way
///   turn centre  (x, y) in body, m: the point that goes straight on while the body turns, the mean of the tracks' instantaneous
///                centres of rotation (Mandow et al., "Experimental kinematics for wheeled skid-steer mobile robots", IROS 2007);
///                wanders with the turn
///
/// The belts say how fast that point p goes, at the ground: v + omega x p = ((1 - scale - slip) u, 0, 0), u their mean speed. The
/// yaw rate is the gyro's: what the belts' difference says of it is mostly scrub. Nothing measures yaw or position, and nothing that
/// is learnt later corrects them (after a kilometre a hair's breadth of scale would be a centimetre of place, again and again):
/// odom is smooth. Only what the IMU alone has drifted while the belts had lost their grip is taken back.
class TrackFilter {
 public:
  struct Settings {
    double gyro_noise_radps_per_sqrt_hz;
    double gyro_bias_std_radps;  ///< at switch-on
    double gyro_bias_walk_radps_per_sqrt_s;
    double accel_noise_mps2_per_sqrt_hz;
    double accel_bias_std_mps2;  ///< at switch-on
    double accel_bias_walk_mps2_per_sqrt_s;
    double turn_std_rad_per_sqrt_rad;  ///< the gyro's scale and misalignment, on turns
    double scale_std;
    double slip_length_m;           ///< of belt, over which slip forgets
    double turn_centre_x_std_m;     ///< sideways slip on turns
    double turn_centre_y_std_m;     ///< the sides grip unlike
    double turn_centre_length_rad;  ///< of turn, over which the centre forgets
    double height_m;                ///< of the body's origin above the ground
  };

  /// Starts at odom's origin, heading along x, tilted as gravity in the first sample says.
  TrackFilter(const Settings& settings, const InertialSample& first);

  /// From the last sample to this one.
  void predict(double dt_s, const InertialSample& sample);
  /// Without IMU: keeps velocity and tilt, turns with the rate that the belts tell.
  void coast(double dt_s, double yaw_rate_radps);

  /// The belts have run: slip and the turn's centre wander on. `slip_std` is what slip usually is on this ground, in this turn.
  void wander(double way_m, double turn_rad, double slip_std);
  /// What the belts said over `dt_s`, when the body moved as `then`; standard deviations of the velocity of the turn's centre, in
  /// body. An innovation beyond the 99.9 % bound is believed less rather than refused.
  void correct_speed(double dt_s, double belts_mps, const TrunkMotion& then, const Eigen::Vector3d& std_mps);
  /// Any velocity, for when nothing better is known.
  void correct_velocity(const Eigen::Vector3d& v_body, double std_mps);
  void correct_gyro_bias(const Eigen::Vector3d& bias_radps, const Eigen::Vector3d& variance);

  /// The belts and the IMU do not agree: the body goes at `forward_mps`, by the IMU; `way_std_m` is what the past may have got
  /// wrong.
  void lose_grip(double forward_mps, double way_std_m);
  /// The belts hold, at rest or at this speed: what was learnt of slip before is void.
  void regain_grip(double belts_mps, double slip_std);
  /// Odom's origin and its x axis are here.
  void set_origin();

  const TrunkMotion& motion() const { return motion_; }
  const Eigen::Vector3d& gyro_bias_radps() const { return gyro_bias_; }
  Eigen::Vector3d up_in_body() const { return motion_.T_odom_body.rotation.conjugate() * Eigen::Vector3d::UnitZ(); }
  /// About odom's z.
  double yaw_rate_radps() const { return (motion_.T_odom_body.rotation * motion_.omega_body).z(); }
  /// As the IMU alone has it over the last step, in body, gravity removed, m/s2.
  double forward_acceleration_mps2() const { return forward_acceleration_mps2_; }
  double scale() const { return scale_; }
  double slip() const { return slip_; }
  const Eigen::Vector2d& turn_centre_m() const { return turn_centre_m_; }

  /// Error covariance: the rows and columns of InertialError, then these.
  static constexpr int kScale = InertialError::kSize, kSlip = kScale + 1, kTurnCentre = kSlip + 1, kSize = kTurnCentre + 2;
  using Covariance = Eigen::Matrix<double, kSize, kSize>;
  const Covariance& covariance() const { return P_; }
  /// What scale, slip and the turn's centre leave open of the velocity ahead and to the left, (m/s)2.
  Eigen::Vector2d lasting_velocity_variance() const;
  /// Of x, y, yaw in odom.
  Eigen::Matrix3d planar_covariance() const;

 private:
  using Gain = Eigen::Matrix<double, kSize, 3>;
  void shift(const Eigen::Matrix<double, kSize, 1>& error);
  void apply(const Gain& W, const Eigen::Matrix3d& S, const Eigen::Vector3d& innovation);
  /// What is learnt from now on does not correct what place and heading have got wrong so far.
  void forget_what_place_owes();
  /// Cuts row and column off from the rest.
  void isolate(int row, double variance);

  Settings settings_;
  TrunkMotion motion_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
  double scale_ = 0.0;
  double slip_ = 0.0;
  Eigen::Vector2d turn_centre_m_ = Eigen::Vector2d::Zero();
  InertialSample last_;
  double forward_acceleration_mps2_ = 0.0;
  double takes_back_s_ = 0.0;      ///< corrections move the place, too, for so much longer
  double smooth_belts_mps_ = 0.0;  ///< carried by the IMU, slowly corrected by the belts
  Covariance P_ = Covariance::Zero();
};

}  // namespace patrol::localize
