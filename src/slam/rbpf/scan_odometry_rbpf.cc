#include "slam/rbpf/scan_odometry_rbpf.h"

namespace patrol::slam {

GridSlamSettings default_filter_settings() {
  GridSlamSettings settings;
  settings.max_extent_m = 2000.0;
  settings.particles = 30;
  settings.initial_keyframes = 10;
  settings.motion = {.longitudinal_std_m_per_m = 0.02,
                     .lateral_std_m_per_m = 0.02,
                     .yaw_std_rad_per_rad = 0.02,
                     .yaw_std_rad_per_m = 0.005,
                     .yaw_std_rad_per_s = 0.0,
                     .min_std_m = 0.005,
                     .min_std_rad = 0.002};
  return settings;
}

ScanOdometryRbpf::ScanOdometryRbpf(const ScanOdometryRbpfSettings& settings, std::uint64_t seed)
    : filtered_(settings.filter, seed) {
  if (row_named(kRbpfOdometries, settings.odometry, "slam.rbpf.odometry").value == RbpfOdometry::kScanMatched)
    tracker_.emplace(settings.scan_odometry);
}

void ScanOdometryRbpf::add(RangeMeasurement measurement) {
  if (tracker_ && !newest_) return;
  if (tracker_)
    measurement.T_odom_body = newest_->T_local_body * (newest_->T_odom_body.inverse() * measurement.T_odom_body);
  filtered_.add(measurement);
}

SlamUpdate ScanOdometryRbpf::update(const LevelScan& scan, const Pose2& T_odom_body) {
  if (!tracker_) return filtered_.update(scan, T_odom_body);
  newest_ = OdometryPair{.T_odom_body = T_odom_body, .T_local_body = tracker_->update(scan, T_odom_body).T_local_body};
  return filtered_.update(scan, newest_->T_local_body);
}

}  // namespace patrol::slam
