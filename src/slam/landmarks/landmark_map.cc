#include "slam/landmarks/landmark_map.h"

#include <Eigen/LU>

namespace patrol::slam {

double LandmarkMap::update(int index, const Pose2& T_map_body, const RangeBearing& seen, const RangeBearingNoise& noise) {
  if (static_cast<std::size_t>(index) >= landmarks_.size()) landmarks_.resize(static_cast<std::size_t>(index) + 1);
  Landmark& landmark = landmarks_[static_cast<std::size_t>(index)];
  if (!landmark.is_seen) {
    landmark.mean_m = landmark_of(T_map_body, seen);
    const Eigen::Matrix2d H_inverse = predict_sight(T_map_body, landmark.mean_m).by_landmark.inverse();
    landmark.covariance = H_inverse * noise.covariance() * H_inverse.transpose();
    landmark.is_seen = true;
    return 0.0;
  }
  const SightFit fit = fit_sight(T_map_body, landmark, seen, noise);
  const Eigen::Matrix2d PHt = landmark.covariance * fit.predicted.by_landmark.transpose();
  const Eigen::Matrix2d K = PHt * fit.S_inverse;
  landmark.mean_m += K * fit.innovation;
  const Eigen::Matrix2d P = landmark.covariance - K * PHt.transpose();
  landmark.covariance = 0.5 * (P + P.transpose());
  return fit.log_density;
}

}  // namespace patrol::slam
