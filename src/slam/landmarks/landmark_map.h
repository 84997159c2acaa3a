#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

#include "slam/landmarks/range_bearing.h"

namespace patrol::slam {

/// A landmark's place in map, normally distributed.
struct Landmark {
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< zero: not seen yet
  bool is_seen = false;
};

/// How well a sight fits what is believed of a landmark, seen from a pose that is taken for certain.
struct SightFit {
  PredictedSight predicted;
  Eigen::Vector2d innovation;
  Eigen::Matrix2d S_inverse;
  double squared_distance = 0.0;  ///< Mahalanobis
  double log_density = 0.0;       ///< without log 2 pi
};

/// How probable sights are together, and nothing else: the innermost loop of a swarm, in closed form and with one logarithm for all.
class SightLikelihood {
 public:
  SightLikelihood(const Pose2& T_map_body, const RangeBearingNoise& noise)
      : T_map_body_(T_map_body), range_variance_(noise.range_std_m * noise.range_std_m), bearing_variance_(noise.bearing_std_rad * noise.bearing_std_rad) {}

  void add(const Landmark& landmark, const RangeBearing& seen) {
    const double dx = landmark.mean_m.x() - T_map_body_.x, dy = landmark.mean_m.y() - T_map_body_.y;
    const double q = std::max(dx * dx + dy * dy, 1e-12), r = std::sqrt(q), u = dx / r, v = dy / r;
    const double a = landmark.covariance(0, 0), b = landmark.covariance(0, 1), c = landmark.covariance(1, 1);
    const double S11 = u * u * a + 2.0 * u * v * b + v * v * c + range_variance_;
    const double S12 = (u * v * (c - a) + (u * u - v * v) * b) / r;
    const double S22 = (v * v * a - 2.0 * u * v * b + u * u * c) / q + bearing_variance_;
    const double det = S11 * S22 - S12 * S12;
    const double range = seen.range_m - r, bearing = wrap_angle(seen.bearing_rad + T_map_body_.yaw - std::atan2(dy, dx));
    squared_distance_ += (S22 * range * range - 2.0 * S12 * range * bearing + S11 * bearing * bearing) / det;
    determinants_ *= det;
    if (determinants_ < 1e-200) flush();
  }

  /// -1/2 sum (nu^T S^-1 nu + log |S|)
  double log_density() const { return -0.5 * (squared_distance_ + log_determinants_ + std::log(determinants_)); }

 private:
  void flush() {
    log_determinants_ += std::log(determinants_);
    determinants_ = 1.0;
  }

  Pose2 T_map_body_;
  double range_variance_, bearing_variance_;
  double squared_distance_ = 0.0, determinants_ = 1.0, log_determinants_ = 0.0;
};

/// Inline, since a caller seldom uses all of it: a step of FastSLAM takes an eighth less time.
inline SightFit fit_sight(const Pose2& T_map_body, const Landmark& landmark, const RangeBearing& seen, const RangeBearingNoise& noise) {
  SightFit fit{.predicted = predict_sight(T_map_body, landmark.mean_m), .innovation = {}, .S_inverse = {}};
  fit.innovation = innovation_of(seen, fit.predicted);
  const Eigen::Matrix2d S = fit.predicted.by_landmark * landmark.covariance * fit.predicted.by_landmark.transpose() + noise.covariance();
  fit.S_inverse = S.inverse();
  fit.squared_distance = fit.innovation.dot(fit.S_inverse * fit.innovation);
  fit.log_density = -0.5 * (fit.squared_distance + std::log(S.determinant()));
  return fit;
}

/// Landmarks of one particle, each with an extended Kalman filter of its own (FastSLAM 1.0: Montemerlo et al., AAAI 2002).
class LandmarkMap {
 public:
  const std::vector<Landmark>& landmarks() const { return landmarks_; }
  std::vector<Landmark>& landmarks() { return landmarks_; }
  bool has(int index) const { return static_cast<std::size_t>(index) < landmarks_.size() && landmarks_[static_cast<std::size_t>(index)].is_seen; }
  const Landmark& at(int index) const { return landmarks_[static_cast<std::size_t>(index)]; }

  /// Takes the sight in: a new landmark begins where it was seen. `index` may be one beyond all. The logarithm of the sight's density, without
  /// log 2 pi; zero for a new landmark's, which says nothing of the pose.
  double update(int index, const Pose2& T_map_body, const RangeBearing& seen, const RangeBearingNoise& noise);

 private:
  std::vector<Landmark> landmarks_;
};

}  // namespace patrol::slam
