#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "conversions.h"
#include "core/geometry/angles.h"
#include "positioning.h"

namespace mrpt_stack {
namespace {

constexpr double kCell_m = 0.05, kMappedRange_m = 8.0;
constexpr float kBorder_m = 8.0F;                // of the grid
constexpr float kOccupied = 0.7F, kFree = 0.4F;  // occupancy probability by one beam that ends in or crosses a cell
constexpr double kBeforeReturn_m = 0.1;          // end of the crossed part of a beam
constexpr double kDriftRatio = 0.02, kYawStd_rad = 0.01;

}  // namespace

std::vector<Eigen::Vector2d> to_points(const patrol::LaserScan& scan, const patrol::Pose3& T_body_lidar,
                                       const Odometry& odometry, double max_range_m) {
  const Pose2 T_body_sensor{T_body_lidar.position.x(), T_body_lidar.position.y(),
                            patrol::to_yaw(T_body_lidar.rotation)};
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (!is_return(scan, scan.ranges_m[i]) || scan.ranges_m[i] > max_range_m) continue;
    const auto beam = static_cast<double>(i), range_m = static_cast<double>(scan.ranges_m[i]);
    const double angle_rad = scan.angle_min_rad + beam * scan.angle_increment_rad;
    const Pose2 T_odom_body = odometry.pose_at(scan.stamp + patrol::from_seconds(beam * scan.time_increment_s));
    points.push_back(T_odom_body *
                     (T_body_sensor * Eigen::Vector2d(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad))));
  }
  return points;
}

ScanMap::ScanMap(const std::vector<Pose2>& goals, const patrol::Pose3& T_body_lidar) : T_body_lidar_(T_body_lidar) {
  Eigen::AlignedBox2f box(Eigen::Vector2f::Zero());
  for (const Pose2& goal : goals) box.extend(goal.position().cast<float>());
  const Eigen::Vector2f low = box.min().array() - kBorder_m, high = box.max().array() + kBorder_m;
  grid_.setSize(low.x(), high.x(), low.y(), high.y(), static_cast<float>(kCell_m));
}

void ScanMap::update(const patrol::LaserScan& scan, const Odometry& odometry) {
  const Eigen::Vector2d p_lidar = odometry.pose() * Eigen::Vector2d(T_body_lidar_.position.head<2>());
  for (const Eigen::Vector2d& p : to_points(scan, T_body_lidar_, odometry, kMappedRange_m)) {
    const Eigen::Vector2d direction = (p - p_lidar).normalized();
    const double crossed_m = (p - p_lidar).norm() - kBeforeReturn_m;
    for (double along_m = 0.0; along_m < crossed_m; along_m += kCell_m) {
      const Eigen::Vector2d q = p_lidar + along_m * direction;
      grid_.updateCell(grid_.x2idx(q.x()), grid_.y2idx(q.y()), 1.0F - kFree);
    }
    grid_.updateCell(grid_.x2idx(p.x()), grid_.y2idx(p.y()), 1.0F - kOccupied);
  }
  const double std_m = kDriftRatio * odometry.distance_m() + 0.02;
  covariance_.diagonal() << std_m * std_m, std_m * std_m, kYawStd_rad * kYawStd_rad;
}

}  // namespace mrpt_stack
