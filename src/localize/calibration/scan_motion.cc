#include "localize/calibration/scan_motion.h"

#include <cmath>
#include <vector>

#include "slam/graph/edge_weight.h"
#include "slam/match_points.h"
#include "slam/scan_integration.h"
#include "slam/scan_matcher.h"

namespace patrol::localize {
namespace {

constexpr double kMaxMapExtent_m = 1000.0;

}  // namespace

ScanMotion::ScanMotion(const ScanMotionSettings& settings) : settings_(settings) {
  settings_.matching.min_inlier_ratio = settings.min_inlier_ratio;
}

std::optional<MatchedScan> ScanMotion::add(const LevelScan& scan, const Pose2& T_odom_level) {
  const Pose2 T_last_now = T_odom_last_.inverse() * T_odom_level;
  T_odom_last_ = T_odom_level;
  length_m_ += T_last_now.position().norm();
  if (!map_ || length_m_ > settings_.map_length_m) {
    begin_map(scan);
    return std::nullopt;
  }
  const std::vector<slam::MatchPoint> points =
      slam::downsample_scan(scan, settings_.matching.point_spacing_m, settings_.matching.max_points);
  const double variance_m2 = settings_.start_std_m * settings_.start_std_m;
  const slam::PoseGaussian prior{
      .mean = T_local_last_ * T_last_now,
      .covariance =
          Eigen::Vector3d(variance_m2, variance_m2, settings_.start_std_rad * settings_.start_std_rad).asDiagonal()};
  const auto match = slam::match_scan(*map_, points, prior.mean, prior, settings_.matching);
  if (!match || !match->converged) {
    begin_map(scan);
    return std::nullopt;
  }
  T_local_last_ = match->T_map_body;
  const Pose2 T_keyframe_level = T_local_keyframe_.inverse() * T_local_last_;
  if (T_keyframe_level.position().norm() > settings_.keyframe_distance_m ||
      std::abs(T_keyframe_level.yaw) > settings_.keyframe_angle_rad)
    integrate(scan);
  return MatchedScan{.map = map_number_,
                     .T_local_level = T_local_last_,
                     .covariance = slam::edge_information(settings_.likelihood_tempering * match->information,
                                                          settings_.match_std_m, settings_.match_std_rad)
                                       .inverse()};
}

void ScanMotion::begin_map(const LevelScan& scan) {
  map_.emplace(settings_.resolution_m, kMaxMapExtent_m);
  ++map_number_;
  length_m_ = 0.0;
  T_local_last_ = {};
  integrate(scan);
}

void ScanMotion::integrate(const LevelScan& scan) {
  slam::integrate_scan(scan, T_local_last_, settings_.integration, *map_);
  T_local_keyframe_ = T_local_last_;
}

}  // namespace patrol::localize
