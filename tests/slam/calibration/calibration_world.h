#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "slam/calibration/motion_segments.h"

namespace patrol::test {

/// A lidar a quarter of a meter ahead of the body and turned by two degrees, on wheels whose way is 3 % too short and
/// whose turn 10 % too large.
inline const slam::Calibration kWorn{.override_lidar_pose = true,
                                     .lidar_x_m = 0.25,
                                     .lidar_y_m = -0.04,
                                     .lidar_yaw_rad = to_rad(2.0),
                                     .distance_scale = 1.03,
                                     .rotation_scale = 0.9,
                                     .steering_bias_rad_per_m = 0.02};

/// Odometry of worn wheels for a true step: the equations of Calibration, solved for odometry.
inline Pose2 reported(const Pose2& step, const slam::Calibration& worn) {
  const Eigen::Vector2d m = Eigen::Rotation2Dd(-0.5 * step.yaw) * step.position() / worn.distance_scale;
  const double turn_rad = (step.yaw - worn.steering_bias_rad_per_m * m.x()) / worn.rotation_scale;
  const Eigen::Vector2d move = Eigen::Rotation2Dd(0.5 * turn_rad) * m;
  return {move.x(), move.y(), turn_rad};
}

struct Noise {
  double odometry_m = 0.0, odometry_rad = 0.0;  ///< standard deviations of each step
  double lidar_m = 0.0, lidar_rad = 0.0;        ///< standard deviations of each pose of the lidar
};

/// Stretches of `steps_per_stretch` true steps of the body, as a worn robot records them.
inline std::vector<slam::MotionSegment> record(const std::vector<Pose2>& steps, std::size_t steps_per_stretch,
                                               const slam::Calibration& worn, const Noise& noise, std::uint64_t seed) {
  const RandomStream odometry(seed, "test/odometry"), lidar(seed, "test/lidar");
  const auto shaken = [](const Pose2& pose, double std_m, double std_rad, const RandomStream& stream,
                         std::uint64_t tick) {
    const auto normals = stream.normals(tick);
    return Pose2{pose.x + std_m * normals[0], pose.y + std_m * normals[1], wrap_angle(pose.yaw + std_rad * normals[2])};
  };
  std::vector<slam::MotionSegment> pairs;
  Pose2 T_local_body, T_local_lidar = worn.T_body_lidar();
  slam::MotionSegment pair;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    T_local_body = T_local_body * steps[k];
    const Pose2 T_local_now = shaken(T_local_body * worn.T_body_lidar(), noise.lidar_m, noise.lidar_rad, lidar, k);
    pair.lidar_steps.push_back(T_local_lidar.inverse() * T_local_now);
    pair.odometry = pair.odometry * shaken(reported(steps[k], worn), noise.odometry_m, noise.odometry_rad, odometry, k);
    T_local_lidar = T_local_now;
    if ((k + 1) % steps_per_stretch != 0) continue;
    const double var_m2 = 2.0 * noise.lidar_m * noise.lidar_m + 1e-10,
                 var_rad2 = 2.0 * noise.lidar_rad * noise.lidar_rad + 1e-12;
    pair.lidar_covariance = Eigen::Vector3d(var_m2, var_m2, var_rad2).asDiagonal();
    pairs.push_back(pair);
    pair = {};
  }
  return pairs;
}

/// Now ahead, now turning to either side.
inline std::vector<Pose2> wandering(std::size_t count) {
  std::vector<Pose2> steps;
  for (std::size_t k = 0; k < count; ++k) {
    const double turn = 0.1 * std::sin(0.037 * static_cast<double>(k)),
                 way = 0.08 + 0.06 * std::cos(0.023 * static_cast<double>(k));
    steps.push_back({way * std::cos(0.5 * turn), way * std::sin(0.5 * turn), turn});
  }
  return steps;
}

}  // namespace patrol::test
