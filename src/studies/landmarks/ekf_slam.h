#pragma once

#include "studies/landmarks/association.h"
#include "studies/landmarks/landmark_slam.h"
#include "studies/landmarks/odometry_bias.h"

namespace patrol::studies {

/// Settings of EkfSlam. The defaults are the recommended method for landmarks (patrol study landmarks-circle,
/// landmarks-100x80): no other method is more accurate, and its covariance is consistent.
struct EkfSlamSettings {
  double noise_scale = 1.0;  ///< scale factor of the stated standard deviations of odometry
  /// The bias is part of the state: about half of the noise of one step; 0: no bias.
  OdometryBiasSettings bias{.std = 0.4};
  bool is_invariant = true;
};

/// SLAM with one extended Kalman filter for the pose, the odometry bias and all landmarks [Smith90]. Known association
/// only.
///
/// Plain variant: the error is the difference of coordinates. The Jacobians depend on the estimate, so that repeated
/// observations of the same landmarks seem to constrain the heading. The filter becomes overconfident [Julier01],
/// [Huang08].
///
/// Invariant variant: the error is a rotation and translation of the whole map about its origin. It is p = exp(dtheta)
/// p_hat + dp for the body and every landmark (right-invariant error on SE_{n+1}(2) [Barrau15]). The Jacobian of an
/// observation with respect to the heading is then exactly zero for every estimate, and unobservable directions gain no
/// information.
class EkfSlam : public LandmarkSlam {
 public:
  EkfSlam(const EkfSlamSettings& settings, ControlMotion motion, const RangeBearingNoise& noise);

  LandmarkSlamEstimate step(const Control& control, const std::vector<RangeBearing>& observations) override;
  std::vector<std::optional<Eigen::Vector2d>> landmarks() const override;
  const OdometryBias& bias() const { return bias_; }

 private:
  // Rows of the covariance: yaw, x, y, speed bias, turn bias, then x, y of each landmark in order of discovery.
  static constexpr Eigen::Index kYaw = 0, kPosition = 1, kBias = 3, kLandmarks = 5;

  void predict(const Control& control);
  void correct(const RangeBearing& observation);
  void add_landmark(const RangeBearing& observation);
  void apply(const Eigen::VectorXd& error);
  LandmarkSlamEstimate summary() const;

  EkfSlamSettings settings_;
  ControlMotion motion_;
  RangeBearingNoise noise_;
  Pose2 T_map_body_;
  OdometryBias bias_;
  std::vector<Eigen::Vector2d> landmarks_;  ///< positions in map, in order of discovery
  std::vector<int> order_;                  ///< [landmark number] -> index in landmarks_, or kUnmatched
  Eigen::MatrixXd P_;
};

}  // namespace patrol::studies
