#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::studies {

/// Range-bearing observation of a landmark from the body.
struct RangeBearing {
  int landmark = 0;  ///< landmark number; used with known association only
  double range_m = 0.0;
  double bearing_rad = 0.0;

  Eigen::Vector2d vector() const { return {range_m, bearing_rad}; }
};

struct RangeBearingNoise {
  double range_std_m = 0.5;
  double bearing_std_rad = 0.0873;  ///< 5 degrees

  Eigen::Matrix2d covariance() const {
    return Eigen::Vector2d(range_std_m * range_std_m, bearing_std_rad * bearing_std_rad).asDiagonal();
  }
};

/// Predicted observation of a landmark at `p_map`, with derivatives.
struct PredictedObservation {
  Eigen::Vector2d observation;         ///< range, bearing
  Eigen::Matrix2d H_landmark;          ///< derivative with respect to x, y of the landmark
  Eigen::Matrix<double, 2, 3> H_pose;  ///< derivative with respect to x, y, yaw of the body
};

inline PredictedObservation predict_observation(const Pose2& T_map_body, const Eigen::Vector2d& p_map) {
  const double dx = p_map.x() - T_map_body.x, dy = p_map.y() - T_map_body.y;
  const double q = std::max(dx * dx + dy * dy, 1e-12), r = std::sqrt(q);
  PredictedObservation predicted;
  predicted.observation = {r, wrap_angle(std::atan2(dy, dx) - T_map_body.yaw)};
  predicted.H_landmark << dx / r, dy / r, -dy / q, dx / q;
  predicted.H_pose.leftCols<2>() = -predicted.H_landmark;
  predicted.H_pose.col(2) = Eigen::Vector2d(0.0, -1.0);
  return predicted;
}

/// Observed minus predicted range and bearing; the bearing is wrapped.
inline Eigen::Vector2d innovation_of(const RangeBearing& observations, const PredictedObservation& predicted) {
  return {observations.range_m - predicted.observation.x(),
          wrap_angle(observations.bearing_rad - predicted.observation.y())};
}

/// Position of the landmark given by an observation.
inline Eigen::Vector2d invert_observation(const Pose2& T_map_body, const RangeBearing& observations) {
  const double direction = T_map_body.yaw + observations.bearing_rad;
  return {T_map_body.x + observations.range_m * std::cos(direction),
          T_map_body.y + observations.range_m * std::sin(direction)};
}

}  // namespace patrol::studies
