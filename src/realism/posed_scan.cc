#include "realism/posed_scan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace patrol::realism {

Pose3 PosedScan::pose_of(std::size_t beam) const {
  if (T_site_lidar.size() == 1 || num_beams() < 2) return T_site_lidar.front();
  const double last = static_cast<double>(T_site_lidar.size() - 1);
  const double at = last * static_cast<double>(beam) / static_cast<double>(num_beams() - 1);
  const std::size_t knot = std::min(static_cast<std::size_t>(at), T_site_lidar.size() - 2);
  return interpolate(T_site_lidar[knot], T_site_lidar[knot + 1], at - static_cast<double>(knot));
}

bool place_scan(const LaserScan& scan, const Trajectory& T_site_body, const Pose3& T_body_lidar, PosedScan& posed) {
  constexpr int kIntervals = 8;       // 12 ms at 10 Hz: short against the motion of a robot
  constexpr double kMaxScan_s = 1.0;  // longer times of beams are an error of the log
  if (scan.ranges_m.empty()) return false;
  const double duration_s = scan.time_increment_s * static_cast<double>(scan.ranges_m.size() - 1);
  const bool has_times = duration_s > 0.0 && duration_s <= kMaxScan_s;
  std::vector<Pose3> poses;
  for (int knot = 0; knot <= (has_times ? kIntervals : 0); ++knot) {
    const Time instant = scan.stamp + from_seconds(duration_s * knot / kIntervals);
    const std::optional<Pose3> T_site_instant = pose_at(T_site_body, has_times ? instant : scan.stamp);
    if (!T_site_instant) return false;
    poses.push_back(*T_site_instant * T_body_lidar);
  }
  posed = {.scan = scan, .T_site_lidar = std::move(poses)};
  return true;
}

PosedScan corrected(const PosedScan& posed, const Eigen::Vector3d& correction) {
  PosedScan result = posed;
  const Eigen::Vector3d center = posed.T_site_lidar.front().position;
  const Eigen::Quaterniond turn = quaternion_from_yaw(correction.z());
  for (Pose3& pose : result.T_site_lidar) {
    pose.position = center + turn * (pose.position - center) + Eigen::Vector3d(correction.x(), correction.y(), 0.0);
    pose.rotation = (turn * pose.rotation).normalized();
  }
  return result;
}

}  // namespace patrol::realism
