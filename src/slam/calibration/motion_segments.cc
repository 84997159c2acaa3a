#include "slam/calibration/motion_segments.h"

#include <cmath>

#include <Eigen/LU>

namespace patrol::slam {
namespace {

/// Covariance of a match alone, in local: 10 m and 10 rad along directions without information.
Eigen::Matrix3d match_covariance(const TrackedScan& tracked, const MotionSegmentSettings& settings) {
  const auto square = [](double value) { return value * value; };
  const Eigen::Matrix3d loose = Eigen::Vector3d(1e-2, 1e-2, 1e-2).asDiagonal();
  const Eigen::Matrix3d systematic =
      Eigen::Vector3d(square(settings.match_std_m), square(settings.match_std_m), square(settings.match_std_rad))
          .asDiagonal();
  return (settings.scan_odometry.likelihood_tempering * tracked.match_information + loose).inverse() + systematic;
}

/// Covariance of b in the frame of a, for independent estimates of a and b in local.
Eigen::Matrix3d relative_covariance(const Pose2& T_local_a, const Eigen::Matrix3d& of_a, const Pose2& T_local_b,
                                    const Eigen::Matrix3d& of_b) {
  const Pose2 T_a_b = T_local_a.inverse() * T_local_b;
  Eigen::Matrix3d by_b = Eigen::Matrix3d::Identity();
  by_b.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-T_local_a.yaw).toRotationMatrix();
  Eigen::Matrix3d by_a = -by_b;
  by_a(0, 2) = T_a_b.y;
  by_a(1, 2) = -T_a_b.x;
  return by_a * of_a * by_a.transpose() + by_b * of_b * by_b.transpose();
}

}  // namespace

MotionSegmenter::MotionSegmenter(const MotionSegmentSettings& settings, const PlanarScanSettings& scan,
                                 const Calibration& prior)
    : settings_(settings), scan_(scan), prior_(prior), tracker_(settings.scan_odometry) {}

void MotionSegmenter::begin(const ScanPose& scan_pose) {
  begin_ = scan_pose;
  lidar_steps_.clear();
}

void MotionSegmenter::add(const RecordedScan& recorded) {
  RecordedScan guess = recorded;
  prior_.correct(guess);
  const Pose2 T_odom_lidar = guess.T_odom_body * guess.T_body_lidar;
  guess.T_begin_end = guess.T_body_lidar.inverse() * guess.T_begin_end * guess.T_body_lidar;
  guess.T_body_lidar = {};
  const TrackedScan tracked = tracker_.update(planar_scan(guess, scan_), T_odom_lidar);
  lidar_steps_.push_back(T_local_last_.inverse() * tracked.T_local_body);
  T_local_last_ = tracked.T_local_body;
  if (!(tracked.inlier_ratio > 0.0)) return;  // both ends of a segment must be matched

  const ScanPose now{.stamp = recorded.scan.stamp,
                     .T_odom_body = recorded.T_odom_body,
                     .T_local_lidar = tracked.T_local_body,
                     .covariance = match_covariance(tracked, settings_)};
  if (!begin_) return begin(now);
  const Pose2 odometry = begin_->T_odom_body.inverse() * now.T_odom_body,
              lidar = begin_->T_local_lidar.inverse() * now.T_local_lidar;
  const double distance_m = std::max(odometry.position().norm(), lidar.position().norm()),
               turn_rad = std::max(std::abs(odometry.yaw), std::abs(lidar.yaw));
  if (distance_m < settings_.length_m && turn_rad < settings_.rotation_rad) return;
  pairs_.push_back({.begin = begin_->stamp,
                    .end = now.stamp,
                    .lidar_steps = std::move(lidar_steps_),
                    .odometry = odometry,
                    .lidar_covariance = relative_covariance(begin_->T_local_lidar, begin_->covariance,
                                                            now.T_local_lidar, now.covariance)});
  begin(now);
}

}  // namespace patrol::slam
