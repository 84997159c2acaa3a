#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/random.h"
#include "studies/landmarks/landmark_slam.h"

namespace patrol::test {

using studies::Control, studies::ControlMotion, studies::LandmarkSlam, studies::RangeBearing,
    studies::RangeBearingNoise, studies::Steering;

/// A vehicle at 1 m/s on a circle of 5 m radius about (0, 5), once round, and landmarks on a circle of 7 m about the
/// same point. It starts at the origin of map.
struct CircleWorld {
  ControlMotion motion;  ///< its deviations are those of odometry's errors
  RangeBearingNoise noise;
  double range_m = 6.0;  ///< maximum range of observed landmarks
  int num_landmarks = 8;
  int blind_steps = 0;  ///< number of initial steps without observations
  Eigen::Vector2d bias =
      Eigen::Vector2d::Zero();  ///< bias of odometry, in its standard deviations, as in studies::OdometryBias

  /// For a circle of 5 m, the turn is length / 5 m: yaw rate v / 5, or sin G / L = 1 / 5.
  Control control() const {
    return {1.0, motion.steering == Steering::kAckermann ? std::asin(motion.wheelbase_m / 5.0) : 0.2};
  }
  int steps() const { return static_cast<int>(std::ceil(10.0 * std::numbers::pi / motion.step_s)); }
  Eigen::Vector2d landmark(int i) const {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / num_landmarks;
    return {7.0 * std::cos(angle), 5.0 + 7.0 * std::sin(angle)};
  }
};

/// Ground truth of a drive, and the readings that the robot receives.
struct Drive {
  std::vector<Pose2> T_map_body;                        ///< [step], after its motion
  std::vector<Control> controls;                        ///< [step], as measured
  std::vector<std::vector<RangeBearing>> observations;  ///< [step][sight]
};

/// The truth is the same for every seed; what is measured differs from it by `noise_share` of the world's noise, and by
/// its bias.
inline Drive drive(const CircleWorld& world, std::uint64_t seed, double noise_share = 1.0) {
  const RandomStream odometry(seed, "test/odometry"), sights(seed, "test/sights");
  Drive drive;
  Pose2 pose;
  for (int k = 0; k < world.steps(); ++k) {
    const auto tick = static_cast<std::uint64_t>(k);
    pose = world.motion.move(pose, world.control());
    drive.T_map_body.push_back(pose);
    const Eigen::Vector2d error =
        noise_share * Eigen::Vector2d(odometry.normal(tick, 0), odometry.normal(tick, 1)) + world.bias;
    drive.controls.push_back(world.control() - world.motion.std.cwiseProduct(error));
    drive.observations.emplace_back();
    for (int i = 0; i < world.num_landmarks && k >= world.blind_steps; ++i) {
      const Eigen::Vector2d observation = studies::predict_observation(pose, world.landmark(i)).observation;
      if (observation.x() > world.range_m) continue;
      const auto draw = sights.normals(tick, static_cast<std::uint64_t>(i));
      drive.observations.back().push_back(
          {.landmark = i,
           .range_m = observation.x() + noise_share * world.noise.range_std_m * draw[0],
           .bearing_rad = wrap_angle(observation.y() + noise_share * world.noise.bearing_std_rad * draw[1])});
    }
  }
  return drive;
}

/// [step]
inline std::vector<studies::LandmarkSlamEstimate> run(LandmarkSlam& slam, const Drive& drive) {
  std::vector<studies::LandmarkSlamEstimate> estimates;
  for (std::size_t k = 0; k < drive.controls.size(); ++k)
    estimates.push_back(slam.step(drive.controls[k], drive.observations[k]));
  return estimates;
}

inline std::vector<Pose2> poses_of(const std::vector<studies::LandmarkSlamEstimate>& estimates) {
  std::vector<Pose2> poses;
  for (const studies::LandmarkSlamEstimate& estimate : estimates) poses.push_back(estimate.T_map_body);
  return poses;
}

/// RMS error of the positions, without alignment: the origin of the map is the start of the robot.
inline double rmse_m(const std::vector<Pose2>& estimated, const std::vector<Pose2>& truth) {
  double sum = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) sum += (estimated[k].position() - truth[k].position()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

/// The path that odometry alone tells.
inline std::vector<Pose2> dead_reckoning(const ControlMotion& motion, const std::vector<Control>& controls) {
  std::vector<Pose2> poses;
  Pose2 pose;
  for (const Control& control : controls) poses.push_back(pose = motion.move(pose, control));
  return poses;
}

}  // namespace patrol::test
