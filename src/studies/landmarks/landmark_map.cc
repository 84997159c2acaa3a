#include "studies/landmarks/landmark_map.h"

#include <Eigen/LU>

namespace patrol::studies {

double LandmarkMap::update(int index, const Pose2& T_map_body, const RangeBearing& observations,
                           const RangeBearingNoise& noise) {
  if (static_cast<std::size_t>(index) >= landmarks_.size()) landmarks_.resize(static_cast<std::size_t>(index) + 1);
  Landmark& landmark = landmarks_[static_cast<std::size_t>(index)];
  if (!landmark.is_observed) {
    landmark.mean_m = invert_observation(T_map_body, observations);
    const Eigen::Matrix2d H_inverse = predict_observation(T_map_body, landmark.mean_m).H_landmark.inverse();
    landmark.covariance = H_inverse * noise.covariance() * H_inverse.transpose();
    landmark.is_observed = true;
    return 0.0;
  }
  const LandmarkInnovation fit = landmark_innovation(T_map_body, landmark, observations, noise);
  const double K00 = (fit.PH00 * fit.S11 - fit.PH01 * fit.S01) / fit.det,
               K01 = (fit.PH01 * fit.S00 - fit.PH00 * fit.S01) / fit.det;
  const double K10 = (fit.PH10 * fit.S11 - fit.PH11 * fit.S01) / fit.det,
               K11 = (fit.PH11 * fit.S00 - fit.PH10 * fit.S01) / fit.det;
  landmark.mean_m.x() += K00 * fit.range + K01 * fit.bearing;
  landmark.mean_m.y() += K10 * fit.range + K11 * fit.bearing;
  Eigen::Matrix2d& P = landmark.covariance;
  P(0, 0) -= K00 * fit.PH00 + K01 * fit.PH01;
  P(1, 1) -= K10 * fit.PH10 + K11 * fit.PH11;
  P(0, 1) = P(1, 0) -= K00 * fit.PH10 + K01 * fit.PH11;
  return fit.log_density();
}

}  // namespace patrol::studies
