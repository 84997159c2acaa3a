#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "core/random.h"
#include "localize/calibration/time_offset_estimator.h"

namespace patrol::test {

constexpr double kSweep_s = 0.1;

/// Smooth planar motion: position and yaw at a time.
using Motion = std::function<Pose2(double)>;

/// Walks with the yaw oscillation of a gait, and turns now and then.
inline Pose2 walking(double t) {
  return {0.7 * t, 0.01 * std::sin(9.0 * t), 0.02 * std::sin(17.45 * t) + 0.6 * std::sin(0.4 * t)};
}

/// Mean of the motion over the sweep that ends at t: what a scan match measures of a sweep that is leveled with the
/// odometry from `offset_s` later.
inline Pose2 matched_pose(const Motion& motion, double t, double offset_s) {
  constexpr int kBeams = 50;
  const Pose2 end = motion(t + offset_s);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int beam = 0; beam < kBeams; ++beam) {
    const double at = t - kSweep_s * (kBeams - 1 - beam) / (kBeams - 1);
    sum += motion(at).vector() - motion(at + offset_s).vector();
  }
  const Eigen::Vector3d mean = sum / kBeams;
  return {end.x + mean.x(), end.y + mean.y(), end.yaw + mean.z()};
}

struct LateLidarNoise {
  double match_m = 0.001, match_rad = 0.0004, jitter_s = 0.0;
};

/// A lidar whose stamps are late by an offset that may change over time.
class LateLidar {
 public:
  LateLidar(std::uint64_t seed, Motion motion, const LateLidarNoise& noise = {})
      : random_(seed, "late_lidar"), motion_(std::move(motion)), noise_(noise) {}

  void run(localize::TimeOffsetEstimator& estimator, double until_s, const std::function<double(double)>& offset_s) {
    for (; t_ < until_s; t_ += kSweep_s, ++scan_) {
      const auto normals = random_.normals(static_cast<std::uint64_t>(scan_));
      const double remaining_s = offset_s(t_) + noise_.jitter_s * normals[3] - applied_s;
      Pose2 pose = matched_pose(motion_, t_, remaining_s);
      pose.x += noise_.match_m * normals[0], pose.y += noise_.match_m * normals[1];
      pose.yaw += noise_.match_rad * normals[2];
      const double stamp_s = t_ + remaining_s;
      estimator.add(
          {.sweep = {.stamp = from_seconds(stamp_s),
                     .duration_s = kSweep_s,
                     .T_odom_begin = motion_(stamp_s - kSweep_s),
                     .T_odom_end = motion_(stamp_s),
                     .applied_time_offset_s = applied_s},
           .match = {.map = 1, .T_local_level = pose, .covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-7).asDiagonal()}});
    }
  }

  /// Runs with a constant offset. The estimate is applied every second, as by the stack: large offsets are linearized
  /// again. `on_second` is called with each second.
  void run_applied(localize::TimeOffsetEstimator& estimator, double offset_s, int until_s,
                   const std::function<void(int)>& on_second = {}) {
    for (int second = 2; second <= until_s; ++second) {
      run(estimator, second, [&](double) { return offset_s; });
      const localize::TimeOffset found = estimator.at(from_seconds(second));
      if (localize::is_applicable(found, applied_s, 0.002)) applied_s = found.value_s;
      if (on_second) on_second(second);
    }
  }

  double applied_s = 0.0;

 private:
  RandomStream random_;
  Motion motion_;
  LateLidarNoise noise_;
  double t_ = 1.0;
  int scan_ = 0;
};

}  // namespace patrol::test
