#include "slam/calibration/motion_residual.h"

#include <array>

#include <Eigen/Geometry>
#include <ceres/jet.h>

namespace patrol::slam {
namespace {

constexpr std::size_t kNumDerivatives = 6;
using Jet = ceres::Jet<double, kNumDerivatives>;

/// Pose without angle wrapping, for automatic differentiation.
struct Motion {
  Jet x, y, yaw;

  friend Motion operator*(const Motion& a, const Motion& b) {
    const Jet c = cos(a.yaw), s = sin(a.yaw);
    return {a.x + c * b.x - s * b.y, a.y + s * b.x + c * b.y, a.yaw + b.yaw};
  }
};

/// Inverse of corrected_step: the odometry increment for a true step.
Motion to_odometry_increment(const Motion& step, const Jet& distance_scale, const Jet& rotation_scale,
                             const Jet& steering) {
  const Jet half = 0.5 * step.yaw;
  const Jet c = cos(half), s = sin(half);
  const Jet ahead = (c * step.x + s * step.y) / distance_scale, left = (c * step.y - s * step.x) / distance_scale;
  const Jet rotation = (step.yaw - steering * ahead) / rotation_scale;
  const Jet co = cos(0.5 * rotation), so = sin(0.5 * rotation);
  return {co * ahead - so * left, so * ahead + co * left, rotation};
}

}  // namespace

MotionResidual motion_residual(const MotionSegment& pair, const CalibrationVector& parameters,
                               const MotionModelSettings& odometry) {
  std::array<Jet, kNumDerivatives> p;
  for (std::size_t i = 0; i < kNumDerivatives; ++i)
    p[i] = Jet(parameters[static_cast<Eigen::Index>(i)], static_cast<int>(i));
  const Motion T_body_lidar{p[0], p[1], p[2]};
  const Jet c = cos(p[2]), s = sin(p[2]);
  const Motion T_lidar_body{-c * p[0] - s * p[1], s * p[0] - c * p[1], -p[2]};
  Motion predicted{Jet(0.0), Jet(0.0), Jet(0.0)};
  for (const Pose2& step : pair.lidar_steps) {
    predicted =
        predicted * to_odometry_increment(T_body_lidar * Motion{Jet(step.x), Jet(step.y), Jet(step.yaw)} * T_lidar_body,
                                          p[3], p[4], p[5]);
  }
  MotionResidual residual;
  residual.error = {predicted.x.a - pair.odometry.x, predicted.y.a - pair.odometry.y,
                    wrap_angle(predicted.yaw.a - pair.odometry.yaw)};
  residual.jacobian << predicted.x.v.transpose(), predicted.y.v.transpose(), predicted.yaw.v.transpose();
  Eigen::Matrix3d R_body_lidar = Eigen::Matrix3d::Identity();
  R_body_lidar.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(parameters[2]).toRotationMatrix();
  residual.lidar_covariance = R_body_lidar * pair.lidar_covariance * R_body_lidar.transpose();
  // Use the predicted motion; an error of the recorded one would change its own weight.
  residual.odometry_covariance =
      predict_motion({}, {predicted.x.a, predicted.y.a, wrap_angle(predicted.yaw.a)}, 0.0, odometry).covariance;
  return residual;
}

}  // namespace patrol::slam
