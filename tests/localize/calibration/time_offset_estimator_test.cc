#include "localize/calibration/time_offset_estimator.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::localize::time_offset_estimator_test {
namespace {

constexpr double kSweep_s = 0.1;

/// Smooth planar motion: position and yaw at a time.
using Motion = std::function<Pose2(double)>;

/// Walks with the yaw oscillation of a gait, and turns now and then.
Pose2 walking(double t) {
  return {0.7 * t, 0.01 * std::sin(9.0 * t), 0.02 * std::sin(17.45 * t) + 0.6 * std::sin(0.4 * t)};
}
Pose2 straight(double t) { return {0.7 * t, 0.0, 0.0}; }

/// Mean of the motion over the sweep that ends at t: what a scan match measures of a sweep that is leveled with the
/// odometry from `offset_s` later.
Pose2 matched_pose(const Motion& motion, double t, double offset_s) {
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

struct Noise {
  double match_m = 0.001, match_rad = 0.0004, jitter_s = 0.0;
};

/// A lidar whose stamps are late by an offset that may change over time.
class LateLidar {
 public:
  LateLidar(std::uint64_t seed, Motion motion, const Noise& noise = {})
      : random_(seed, "late_lidar"), motion_(std::move(motion)), noise_(noise) {}

  void run(TimeOffsetEstimator& estimator, double until_s, const std::function<double(double)>& offset_s) {
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

  double applied_s = 0.0;

 private:
  RandomStream random_;
  Motion motion_;
  Noise noise_;
  double t_ = 1.0;
  int scan_ = 0;
};

// The estimate is applied every second, as by the stack: large offsets are linearized again.
TEST(TimeOffsetEstimator, RecoversOffsetsOfBothSigns) {
  for (const double offset_s : {-0.05, -0.02, -0.005, 0.0, 0.005, 0.02, 0.05}) {
    TimeOffsetEstimator estimator({});
    LateLidar lidar(7, walking);
    for (int second = 2; second <= 20; ++second) {
      lidar.run(estimator, second, [&](double) { return offset_s; });
      const TimeOffset found = estimator.at(from_seconds(second));
      if (is_applicable(found, lidar.applied_s, 0.002)) lidar.applied_s = found.value_s;
    }
    const TimeOffset found = estimator.at(from_seconds(20.0));
    EXPECT_LT(found.std_s, 0.0016) << offset_s << ", of which 1.5 ms are the lag of odometry";
    EXPECT_NEAR(found.value_s, offset_s, 0.001) << offset_s;
  }
}

TEST(TimeOffsetEstimator, AccountsForTheAppliedOffset) {
  TimeOffsetEstimator estimator({});
  LateLidar lidar(8, walking);
  for (int second = 2; second <= 20; ++second) {
    lidar.applied_s = 0.02 * std::min(1.0, second / 10.0);
    lidar.run(estimator, second, [](double) { return 0.02; });
  }
  EXPECT_NEAR(estimator.at(from_seconds(20.0)).value_s, 0.02, 0.001);
}

// The errors include a jitter of 1 ms; the lag of odometry, which this plant does not have, is left out.
TEST(TimeOffsetEstimator, IsConsistentOverManySeeds) {
  double sum = 0.0;
  constexpr int kSeeds = 60;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    TimeOffsetEstimatorSettings settings;
    settings.odometry_lag_std_s = 0.0;
    TimeOffsetEstimator estimator(settings);
    const double offset_s = 0.003 * RandomStream(seed, "offset").normal(0);
    LateLidar(seed, walking, {.jitter_s = 0.001}).run(estimator, 40.0, [&](double) { return offset_s; });
    const TimeOffset found = estimator.at(from_seconds(40.0));
    sum += std::pow((found.value_s - offset_s) / found.std_s, 2);
  }
  EXPECT_GT(sum / kSeeds, 0.3);
  EXPECT_LT(sum / kSeeds, 2.0);
}

TEST(TimeOffsetEstimator, KeepsItsPriorForStraightMotionAtConstantSpeed) {
  TimeOffsetEstimatorSettings settings;
  TimeOffsetEstimator estimator(settings);
  LateLidar(9, straight).run(estimator, 60.0, [](double) { return 0.02; });
  EXPECT_GT(estimator.at(from_seconds(60.0)).std_s, 0.9 * settings.prior_std_s);
}

TEST(TimeOffsetEstimator, FollowsTheDriftOfAClock) {
  TimeOffsetEstimator estimator({});
  const auto offset_s = [](double t) { return 0.002 + 2e-5 * t; };
  LateLidar(10, walking).run(estimator, 300.0, offset_s);
  const TimeOffset found = estimator.at(from_seconds(300.0));
  EXPECT_NEAR(found.value_s, offset_s(300.0), 3.0 * found.std_s);
  EXPECT_NEAR(found.drift_s_per_s, 2e-5, 3.0 * found.drift_std_s_per_s);
  EXPECT_EQ(estimator.num_steps(), 0);
}

TEST(TimeOffsetEstimator, DetectsAStepAndStartsAgain) {
  TimeOffsetEstimator estimator({});
  LateLidar lidar(11, walking);
  lidar.run(estimator, 60.0, [](double) { return 0.0; });
  EXPECT_EQ(estimator.num_steps(), 0);
  lidar.run(estimator, 90.0, [](double) { return -0.02; });
  EXPECT_EQ(estimator.num_steps(), 1);
  EXPECT_NEAR(estimator.at(from_seconds(90.0)).value_s, -0.02, 0.002);
}

}  // namespace
}  // namespace patrol::localize::time_offset_estimator_test
