#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

namespace patrol::studies {

/// Prior of a constant or slowly varying error of odometry.
struct OdometryBiasSettings {
  double std = 0.0;       ///< standard deviation of the bias, in standard deviations of the odometry noise; 0: no bias
  double walk_std = 0.0;  ///< standard deviation of the random walk per step
};

/// Normally distributed odometry bias, in standard deviations of the odometry noise. The trajectory of a particle gives
/// its increments exactly. Conditioned on it the bias is linear Gaussian, so a Kalman filter estimates it
/// (Rao-Blackwellization).
struct OdometryBias {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();

  explicit OdometryBias(const OdometryBiasSettings& settings = {}) {
    covariance.diagonal().setConstant(settings.std * settings.std);
  }

  /// Covariance of the next increment: bias plus noise of unit variance.
  Eigen::Matrix2d increment_covariance() const { return covariance + Eigen::Matrix2d::Identity(); }

  /// Cholesky factor of increment_covariance(), lower triangular: root root^T is the covariance.
  Eigen::Matrix2d increment_root() const {
    const double l00 = std::sqrt(1.0 + covariance(0, 0)), l10 = covariance(1, 0) / l00;
    return (Eigen::Matrix2d() << l00, 0.0, l10, std::sqrt(1.0 + covariance(1, 1) - l10 * l10)).finished();
  }

  /// Updates the bias with an increment xi = bias + noise.
  void add_increment(const Eigen::Vector2d& increment, const OdometryBiasSettings& settings) {
    const Eigen::Matrix2d K = covariance * increment_covariance().inverse();
    mean += K * (increment - mean);
    covariance -= K * covariance;
    covariance = (0.5 * (covariance + covariance.transpose())).eval();
    covariance.diagonal().array() += settings.walk_std * settings.walk_std;
  }
};

}  // namespace patrol::studies
