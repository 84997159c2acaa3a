#pragma once

#include <Eigen/Core>

#include <limits>
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

SightFit fit_sight(const Pose2& T_map_body, const Landmark& landmark, const RangeBearing& seen, const RangeBearingNoise& noise);

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
