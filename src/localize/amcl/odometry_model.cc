#include "localize/amcl/odometry_model.h"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/geometry/linear_algebra.h"

namespace patrol::localize {

void propagate_particles(ParticleCloud& cloud, const Pose2& T_before_now, double dt_s,
                         const OdometryModelSettings& settings, const RandomStream& noise, std::uint64_t tick) {
  const slam::PoseGaussian step = slam::predict_motion({}, T_before_now, dt_s, settings.noise);
  const Eigen::Matrix3d L = cholesky_factor(step.covariance);
  const double kept = std::exp(-T_before_now.position().norm() / settings.scale_correlation_length_m);
  const double renewed = settings.scale_std * std::sqrt(1.0 - kept * kept);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::array<double, 4> unit = noise.normals(tick, i);
    double& scale = cloud.odometry_scale[i];
    scale = kept * scale + renewed * unit[3];
    const Eigen::Vector3d error = L * Eigen::Vector3d(unit[0], unit[1], unit[2]);
    const Pose2 T_sampled{(1.0 + scale) * T_before_now.x + error.x(), (1.0 + scale) * T_before_now.y + error.y(),
                          T_before_now.yaw + error.z()};
    cloud.T_map_body[i] = cloud.T_map_body[i] * T_sampled;
  }
}

slam::PoseGaussian predict(const slam::PoseGaussian& before, const Pose2& T_before_now, double dt_s,
                           const OdometryModelSettings& settings) {
  slam::PoseGaussian now = slam::predict_motion(before.mean, T_before_now, dt_s, settings.noise);
  const Eigen::Vector2d increment = now.mean.position() - before.mean.position();
  Eigen::Matrix3d swing = Eigen::Matrix3d::Identity();  // Jacobian: a heading error rotates the increment
  swing(0, 2) = -increment.y(), swing(1, 2) = increment.x();
  now.covariance += swing * before.covariance * swing.transpose();
  now.covariance.topLeftCorner<2, 2>() += settings.scale_std * settings.scale_std * increment * increment.transpose();
  return now;
}

}  // namespace patrol::localize
