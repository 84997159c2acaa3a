#include "localize/range_filter.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "localize/track_odometry.h"
#include "tests/support/tracked_drive.h"
#include "tests/support/uwb_tunnel.h"

namespace patrol::localize {
namespace {

using test::make_tracked_robot;
using test::make_tunnel_anchors;
using test::stand_then_weave;
using test::TrackedDrive;
using test::UwbPolls;

struct TunnelRun {
  double max_error_m = 0.0;
  double max_odometry_error_m = 0.0;
  double mean_nees = 0.0;  ///< of x, y, yaw, once a second
  double end_nees = 0.0;
  double nis_sum = 0.0;  ///< of the clear ranges
  int num_clear = 0, num_blocked = 0, num_blocked_accepted = 0, num_clear_refused = 0;
  std::uint64_t doubts = 0;
};

struct TunnelSetting {
  double blocked_share = 0.0;
  double until_s = 303.0;
  double start_error_m = 0.0;
};

TunnelRun drive_tunnel(std::uint64_t seed, const TunnelSetting& setting) {
  const RobotDescription robot = make_tracked_robot();
  const double height = robot.tracks->body_height_m;
  TrackedDrive drive(robot, stand_then_weave(), {}, seed);
  TrackOdometry odometry(robot, {});
  UwbPolls polls{.anchors = make_tunnel_anchors(-10.0, 170.0), .blocked_share = setting.blocked_share};
  for (UwbAnchor& anchor : polls.anchors) anchor.p_m.z() -= height;  // map's origin is the body at its start
  RangeFilter filter({}, polls.anchors, robot.T_body("uwb"));

  TunnelRun result;
  std::uint64_t tick = 0, step = 0;
  int seconds = 0;
  while (to_seconds(drive.now()) < setting.until_s) {
    drive.step();
    odometry.add(drive.imu());
    if (!drive.has_ticks()) continue;
    odometry.add(drive.ticks());
    const auto estimate = odometry.estimate();
    if (!estimate) continue;
    Pose3 T_map_body = drive.T_world_body();
    T_map_body.position.z() -= height;
    if (!filter.has_started()) {
      PoseEstimate start;
      start.stamp = estimate->stamp;
      start.T_map_body = {setting.start_error_m, 0.0, 0.0};
      start.covariance.diagonal() << 0.05 * 0.05, 0.05 * 0.05, 0.01 * 0.01;
      filter.start_at(start, estimate->T_odom_body);
    }
    filter.predict(estimate->stamp, estimate->T_odom_body, odometry.twist_std());
    if (++step % 2 != 0) continue;
    if (const auto poll = polls.poll(seed, ++tick, drive.now(), T_map_body, robot.T_body("uwb"))) {
      const RangeOutcome outcome = filter.add(poll->range, *odometry.T_odom_body_at(poll->range.stamp));
      if (poll->is_blocked) {
        ++result.num_blocked;
        if (outcome.is_accepted()) ++result.num_blocked_accepted;
      } else {
        ++result.num_clear;
        if (!outcome.is_accepted()) ++result.num_clear_refused;
        result.nis_sum += outcome.nis();
      }
    }
    const PoseEstimate pose = filter.estimate(drive.now(), estimate->T_odom_body);
    const Pose2 truth = to_planar(T_map_body);
    const Eigen::Vector3d error(pose.T_map_body.x - truth.x, pose.T_map_body.y - truth.y, wrap_angle(pose.T_map_body.yaw - truth.yaw));
    result.max_error_m = std::max(result.max_error_m, error.head<2>().norm());
    result.max_odometry_error_m = std::max(result.max_odometry_error_m, (estimate->T_odom_body.position - T_map_body.position).head<2>().norm());
    if (to_seconds(drive.now()) >= seconds + 10.0) {
      ++seconds;
      result.end_nees = error.dot(pose.covariance.inverse() * error);
      result.mean_nees += result.end_nees;
    }
  }
  result.mean_nees /= seconds;
  result.doubts = filter.doubts();
  return result;
}

TEST(RangeFilter, Explore) {
  for (double share : {0.0, 0.3}) {
    double nees = 0, end = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const TunnelRun r = drive_tunnel(seed, {.blocked_share = share});
      nees += r.mean_nees / 10; end += r.end_nees / 10;
      std::printf("share %.1f seed %lu max %.3f odo %.2f nees %.2f end %.2f nis %.3f n %d refused clear %d blocked %d accepted %d doubts %lu\n", share, seed, r.max_error_m, r.max_odometry_error_m, r.mean_nees, r.end_nees, r.nis_sum / r.num_clear, r.num_clear, r.num_clear_refused, r.num_blocked, r.num_blocked_accepted, r.doubts);
    }
    std::printf("mean nees %.2f end %.2f\n", nees, end);
  }
}

}  // namespace
}  // namespace patrol::localize
