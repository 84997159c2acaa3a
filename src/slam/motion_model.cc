#include "slam/motion_model.h"

#include <cmath>

namespace patrol::slam {

PoseGaussian predict_motion(const Pose2& T_map_before, const Pose2& T_before_now, double dt_s,
                            const MotionModelSettings& settings) {
  const Eigen::Vector2d move_body = T_before_now.position();
  const double distance_m = move_body.norm();
  const double rotation_rad = std::abs(wrap_angle(T_before_now.yaw));
  const double along_std = settings.longitudinal_std_m_per_m * distance_m;
  const double across_std = settings.lateral_std_m_per_m * distance_m;
  const auto square = [](double value) { return value * value; };

  // Unit vectors along and across the motion, in map.
  const Eigen::Rotation2Dd R_map_before(T_map_before.yaw);
  const Eigen::Vector2d along =
      distance_m > 0.0 ? Eigen::Vector2d(R_map_before * (move_body / distance_m)) : Eigen::Vector2d::UnitX();
  const Eigen::Vector2d across(-along.y(), along.x());
  PoseGaussian predicted{.mean = T_map_before * T_before_now};
  predicted.covariance.topLeftCorner<2, 2>() = square(settings.min_std_m) * Eigen::Matrix2d::Identity() +
                                               square(along_std) * along * along.transpose() +
                                               square(across_std) * across * across.transpose();
  predicted.covariance(2, 2) = square(settings.min_std_rad) + square(settings.yaw_std_rad_per_rad * rotation_rad) +
                               square(settings.yaw_std_rad_per_m * distance_m) +
                               square(settings.yaw_std_rad_per_s * dt_s);
  return predicted;
}

}  // namespace patrol::slam
