#pragma once

#include "slam/landmarks/association.h"
#include "slam/landmarks/landmark_slam.h"
#include "slam/landmarks/odometry_bias.h"

namespace patrol::slam {

/// The defaults are our best method for landmarks (patrol study landmarks-circle, landmarks-100x80): as accurate as any, and it knows how accurate it is.
struct EkfSlamSettings {
  double noise_scale = 1.0;                  ///< of odometry's stated deviations
  OdometryBiasSettings bias{.std = 0.4};     ///< a part of the state: about half of the noise of one step; 0: odometry is believed to have none
  bool is_invariant = true;
};

/// SLAM with one extended Kalman filter for pose, bias of odometry and all landmarks together (Smith, Self, Cheeseman 1990). Known association.
///
/// Plain: the error is the difference of coordinates. Its Jacobians are taken where the estimate happens to be, so that the filter believes
/// that it learns its heading from looking at the same landmarks twice, and ends overconfident (Julier, Uhlmann 2001; Huang et al. 2008).
///
/// Invariant: the error is what a rotation and shift of the whole map about its origin leaves: p = exp(dtheta) p_hat + dp, the same for the body and
/// every landmark (right-invariant error on SE_{n+1}(2); Barrau, Bonnabel, "An EKF-SLAM algorithm with consistency properties", 2015). Then a sight's
/// Jacobian by the heading is exactly zero, whatever the estimate, and what cannot be observed is never learnt.
class EkfSlam : public LandmarkSlam {
 public:
  EkfSlam(const EkfSlamSettings& settings, const ControlMotion& motion, const RangeBearingNoise& noise);

  LandmarkSlamEstimate step(const Control& control, const std::vector<RangeBearing>& seen) override;
  std::vector<std::optional<Eigen::Vector2d>> landmarks() const override;
  const OdometryBias& bias() const { return bias_; }

 private:
  // Rows of the covariance: yaw, x, y, bias of speed, bias of turn, then x, y of each landmark in the order in which they were first seen.
  static constexpr Eigen::Index kYaw = 0, kPosition = 1, kBias = 3, kLandmarks = 5;

  void predict(const Control& control);
  void correct(const RangeBearing& sight);
  void add_landmark(const RangeBearing& sight);
  void apply(const Eigen::VectorXd& error);
  LandmarkSlamEstimate summary() const;

  EkfSlamSettings settings_;
  ControlMotion motion_;
  RangeBearingNoise noise_;
  Pose2 T_map_body_;
  OdometryBias bias_;
  std::vector<Eigen::Vector2d> landmarks_;  ///< in map, in the order in which they were first seen
  std::vector<int> order_;                  ///< [landmark's number] -> index of the former, or kUnmatched
  Eigen::MatrixXd P_;
};

}  // namespace patrol::slam
