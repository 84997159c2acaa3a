#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "studies/landmarks/range_bearing.h"

namespace patrol::studies {

/// Normally distributed landmark position in map.
struct Landmark {
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< zero: not observed yet
  bool is_observed = false;
};

/// Innovation of an observation with respect to an estimated landmark, at a pose without uncertainty. In closed form,
/// because this is the innermost loop of every swarm. With u the direction to the landmark and n perpendicular to it, H
/// = [u^T; n^T / r].
struct LandmarkInnovation {
  double range = 0.0, bearing = 0.0;   ///< innovation, m and rad
  double ux = 0.0, uy = 0.0, r = 0.0;  ///< direction and distance of the landmark, m
  double PH00 = 0.0, PH01 = 0.0;       ///< P H^T, cross covariance of landmark position and observation
  double PH10 = 0.0, PH11 = 0.0;
  double S00 = 0.0, S01 = 0.0, S11 = 0.0, det = 0.0;  ///< S = H P H^T + R, and its determinant
  double squared_distance = 0.0;                      ///< squared Mahalanobis distance

  /// Log density of the observation without the log 2 pi term.
  double log_density() const { return -0.5 * (squared_distance + std::log(det)); }
  Eigen::Vector2d innovation() const { return {range, bearing}; }
  Eigen::Matrix2d S_inverse() const { return (Eigen::Matrix2d() << S11, -S01, -S01, S00).finished() / det; }
  Eigen::Matrix<double, 2, 3> H_pose() const {
    return (Eigen::Matrix<double, 2, 3>() << -ux, -uy, 0.0, uy / r, -ux / r, -1.0).finished();
  }
};

inline LandmarkInnovation landmark_innovation(const Pose2& T_map_body, const Landmark& landmark,
                                              const RangeBearing& observations, const RangeBearingNoise& noise) {
  LandmarkInnovation fit;
  const double dx = landmark.mean_m.x() - T_map_body.x, dy = landmark.mean_m.y() - T_map_body.y;
  fit.r = std::sqrt(std::max(dx * dx + dy * dy, 1e-12));
  fit.ux = dx / fit.r;
  fit.uy = dy / fit.r;
  fit.range = observations.range_m - fit.r;
  fit.bearing = wrap_angle(observations.bearing_rad + T_map_body.yaw - std::atan2(dy, dx));
  const double nx = -fit.uy / fit.r, ny = fit.ux / fit.r;
  const Eigen::Matrix2d& P = landmark.covariance;
  fit.PH00 = P(0, 0) * fit.ux + P(0, 1) * fit.uy;
  fit.PH10 = P(0, 1) * fit.ux + P(1, 1) * fit.uy;
  fit.PH01 = P(0, 0) * nx + P(0, 1) * ny;
  fit.PH11 = P(0, 1) * nx + P(1, 1) * ny;
  fit.S00 = fit.ux * fit.PH00 + fit.uy * fit.PH10 + noise.range_std_m * noise.range_std_m;
  fit.S01 = fit.ux * fit.PH01 + fit.uy * fit.PH11;
  fit.S11 = nx * fit.PH01 + ny * fit.PH11 + noise.bearing_std_rad * noise.bearing_std_rad;
  fit.det = fit.S00 * fit.S11 - fit.S01 * fit.S01;
  fit.squared_distance = (fit.S11 * fit.range * fit.range - 2.0 * fit.S01 * fit.range * fit.bearing +
                          fit.S00 * fit.bearing * fit.bearing) /
                         fit.det;
  return fit;
}

/// Joint log density of several observations with a single logarithm.
class ObservationLikelihood {
 public:
  ObservationLikelihood(const Pose2& T_map_body, const RangeBearingNoise& noise)
      : T_map_body_(T_map_body), noise_(noise) {}

  void add(const Landmark& landmark, const RangeBearing& observations) {
    const LandmarkInnovation fit = landmark_innovation(T_map_body_, landmark, observations, noise_);
    squared_distance_ += fit.squared_distance;
    determinants_ *= fit.det;
    if (determinants_ < 1e-200) flush();
  }

  /// Returns -1/2 sum (nu^T S^-1 nu + log |S|).
  double log_density() const { return -0.5 * (squared_distance_ + log_determinants_ + std::log(determinants_)); }

 private:
  void flush() {
    log_determinants_ += std::log(determinants_);
    determinants_ = 1.0;
  }

  Pose2 T_map_body_;
  RangeBearingNoise noise_;
  double squared_distance_ = 0.0, determinants_ = 1.0, log_determinants_ = 0.0;
};

/// Landmarks of one particle, each estimated by an extended Kalman filter (FastSLAM 1.0 [Montemerlo02]).
class LandmarkMap {
 public:
  const std::vector<Landmark>& landmarks() const { return landmarks_; }
  std::vector<Landmark>& landmarks() { return landmarks_; }
  bool has(int index) const {
    return static_cast<std::size_t>(index) < landmarks_.size() &&
           landmarks_[static_cast<std::size_t>(index)].is_observed;
  }
  const Landmark& at(int index) const { return landmarks_[static_cast<std::size_t>(index)]; }

  /// Updates a landmark with an observation; a new landmark is initialized at the observed position. `index` may be one
  /// beyond the last. Returns the log density of the observation without the log 2 pi term; zero for a new landmark,
  /// which does not constrain the pose.
  double update(int index, const Pose2& T_map_body, const RangeBearing& observations, const RangeBearingNoise& noise);

 private:
  std::vector<Landmark> landmarks_;
};

}  // namespace patrol::studies
