#include "localize/track_odometry.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "tests/support/tracked_drive.h"

namespace patrol::localize {
namespace {

using test::make_tour;
using test::make_tracked_robot;
using test::stand_then_drive;
using test::TrackedDrive;
using test::TrackedDriveSettings;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Which messages get through at a time.
struct Channels {
  bool imu = true, ticks = true;
};
using Outage = std::function<Channels(double time_s)>;

void run(TrackedDrive& drive, TrackOdometry& odometry, double until_s, const Outage& outage = nullptr) {
  while (to_seconds(drive.now()) < until_s) {
    drive.step();
    const Channels on = outage ? outage(to_seconds(drive.now())) : Channels{};
    if (on.imu) odometry.add(drive.imu());
    if (on.ticks && drive.has_ticks()) odometry.add(drive.ticks());
  }
}

/// Estimate less truth: x, y, yaw. Odom starts where the robot has stood, which is the world's origin.
Eigen::Vector3d planar_error(const TrackOdometry& odometry, const TrackedDrive& drive) {
  const Pose2 estimate = to_planar(odometry.estimate()->T_odom_body), truth = to_planar(drive.T_world_body());
  return {estimate.x - truth.x, estimate.y - truth.y, wrap_angle(estimate.yaw - truth.yaw)};
}

double nees(const TrackOdometry& odometry, const TrackedDrive& drive) {
  const Eigen::Vector3d error = planar_error(odometry, drive);
  return error.dot(odometry.estimate()->planar_covariance.inverse() * error);
}

TEST(TrackOdometry, Quiet) {
  for (int variant = 0; variant < 2; ++variant) {
    auto st = TrackedDriveSettings::without_noise();
    if (variant == 1) st.ticks_per_sprocket_turn = 360;
    if (variant == 2) st.pitch_rad = st.roll_rad = 0;
    if (variant == 3) st.max_belt_acceleration_mps2 = 0.2;
      TrackedDrive drive(make_tracked_robot(), make_tour(), st, 1);
      TrackOdometry odometry(make_tracked_robot(), {.ticks_per_sprocket_turn = st.ticks_per_sprocket_turn});
      for (double t : {3.2, 4.0, 5.0, 10.0, 16.0, 60.0}) {
      run(drive, odometry, t);
      auto& f = *odometry.filter();
      const Eigen::Vector3d e = planar_error(odometry, drive);
      std::printf("v%d t %.1f e %.4f %.4f %.5f scale %.5f slip %.5f centre %.4f %.4f v %.4f true %.4f gyro bias %.5f\n", variant, t, e.x(), e.y(), e.z(), f.scale(), f.slip(), f.turn_centre_m().x(), f.turn_centre_m().y(), f.motion().v_body.x(), drive.speed_mps(), f.gyro_bias_radps().y());
      }
  }
}

TEST(TrackOdometry, Explore) {
  for (double until : {10.0, 16.0, 30.0, 60.0, 120.0, 240.0}) {
    double sum = 0;
    Eigen::Vector3d e2 = Eigen::Vector3d::Zero(), v2 = e2; double way = 0; unsigned long slips = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      TrackedDrive drive(make_tracked_robot(), make_tour(), {}, seed);
      TrackOdometry odometry(make_tracked_robot(), {});
      run(drive, odometry, until);
      const double n = nees(odometry, drive);
      const Eigen::Vector3d e = planar_error(odometry, drive);
      e2 += e.cwiseAbs2() / 20; v2 += odometry.estimate()->planar_covariance.diagonal() / 20;
      sum += n; way += drive.way_m() / 20; slips += odometry.health().slip_events;
      if (until == 61.0) std::printf("  seed %lu e %.3f %.3f %.4f sigma %.3f %.3f %.4f nees %.2f bias err %.5f +- %.5f z %.3f\n", seed, e.x(), e.y(), e.z(), std::sqrt(odometry.estimate()->planar_covariance(0,0)), std::sqrt(odometry.estimate()->planar_covariance(1,1)), std::sqrt(odometry.estimate()->planar_covariance(2,2)), n, odometry.filter()->gyro_bias_radps().z() - drive.gyro_z_bias_radps(), odometry.health().gyro_z_bias_std_radps, odometry.estimate()->T_odom_body.position.z() + 0.25 - drive.T_world_body().position.z());
    }
    std::printf("t %.0f way %.1f NEES/20 = %.2f rms %.3f %.3f %.4f  sigma %.3f %.3f %.4f slips %lu\n", until, way, sum / 20, std::sqrt(e2.x()), std::sqrt(e2.y()), std::sqrt(e2.z()), std::sqrt(v2.x()), std::sqrt(v2.y()), std::sqrt(v2.z()), slips);
  }
}

}  // namespace
}  // namespace patrol::localize
