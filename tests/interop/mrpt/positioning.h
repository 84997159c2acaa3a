#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include "core/frames.h"
#include "core/grid.h"
#include "core/sensors/registry.h"
#include "odometry.h"

namespace mrpt_stack {

/// Pose of the robot in map, and the occupancy grid that the planner uses.
class Positioning {
 public:
  virtual ~Positioning() = default;

  virtual void update(const patrol::LaserScan& scan, const Odometry& odometry) = 0;
  /// Returns the pose of the body in map at a pose of odometry.
  virtual Pose2 pose_at(const Pose2& T_odom_body) const = 0;
  virtual const Eigen::Matrix3d& covariance() const = 0;
  virtual const mrpt::maps::COccupancyGridMap2D& grid() const = 0;
};

/// Monte Carlo localization on a known map.
class Localization final : public Positioning {
 public:
  Localization(const patrol::OccupancyGrid& map, const Pose2& T_map_start, const patrol::Pose3& T_body_lidar,
               std::uint64_t seed);

  /// Moves the particles by odometry, and weights them by the scan if the robot has moved.
  void update(const patrol::LaserScan& scan, const Odometry& odometry) override;
  Pose2 pose_at(const Pose2& T_odom_body) const override { return T_map_odom_ * T_odom_body; }
  const Eigen::Matrix3d& covariance() const override { return covariance_; }
  const mrpt::maps::COccupancyGridMap2D& grid() const override { return *map_; }

 private:
  mrpt::maps::COccupancyGridMap2D::Ptr map_;
  mrpt::slam::CMonteCarloLocalization2D filter_;
  patrol::Pose3 T_body_lidar_;
  Pose2 last_T_odom_body_;
  Pose2 T_map_odom_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

/// Points of a scan in odom, each from the pose at the time of its beam.
std::vector<Eigen::Vector2d> to_points(const patrol::LaserScan& scan, const patrol::Pose3& T_body_lidar,
                                       const Odometry& odometry, double max_range_m);

/// Without a map: the pose is that of odometry from the surveyed start, without localization. The grid is made of the
/// scans by MRPT's Bayesian update of cells, and covers a rectangle around start and goals.
class ScanMap final : public Positioning {
 public:
  /// `goals`: in map, whose origin is the start.
  ScanMap(const std::vector<Pose2>& goals, const patrol::Pose3& T_body_lidar);

  void update(const patrol::LaserScan& scan, const Odometry& odometry) override;
  Pose2 pose_at(const Pose2& T_odom_body) const override { return T_odom_body; }
  const Eigen::Matrix3d& covariance() const override { return covariance_; }
  const mrpt::maps::COccupancyGridMap2D& grid() const override { return grid_; }

 private:
  mrpt::maps::COccupancyGridMap2D grid_;
  patrol::Pose3 T_body_lidar_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace mrpt_stack
