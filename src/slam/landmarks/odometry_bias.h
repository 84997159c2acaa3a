#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>

namespace patrol::slam {

/// What is known of a lasting error of odometry before anything is seen.
struct OdometryBiasSettings {
  double std = 0.0;       ///< in standard deviations of odometry's noise; 0: odometry is believed to have none
  double walk_std = 0.0;  ///< how far it wanders in one step
};

/// The bias of odometry, normally distributed, in standard deviations of its noise. A particle's own path tells it exactly what its
/// increments were; given the path the bias is linear and Gaussian, and a Kalman filter carries all that is known of it (Rao-Blackwell).
struct OdometryBias {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  explicit OdometryBias(const OdometryBiasSettings& settings = {}) { covariance.diagonal().setConstant(settings.std * settings.std); }

  /// Of the next increment: bias and noise of unit variance.
  Eigen::Matrix2d increment_covariance() const { return covariance + Eigen::Matrix2d::Identity(); }

  /// Lower triangular, root root^T is the covariance (Cholesky).
  Eigen::Matrix2d increment_root() const {
    const double l00 = std::sqrt(1.0 + covariance(0, 0)), l10 = covariance(1, 0) / l00;
    return (Eigen::Matrix2d() << l00, 0.0, l10, std::sqrt(1.0 + covariance(1, 1) - l10 * l10)).finished();
  }

  /// An increment xi = bias + noise was taken.
  void learn(const Eigen::Vector2d& increment, const OdometryBiasSettings& settings) {
    const Eigen::Matrix2d K = covariance * increment_covariance().inverse();
    mean += K * (increment - mean);
    covariance -= K * covariance;
    covariance = (0.5 * (covariance + covariance.transpose())).eval();
    covariance.diagonal().array() += settings.walk_std * settings.walk_std;
  }
};

}  // namespace patrol::slam
