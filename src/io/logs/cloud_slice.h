#pragma once

#include <Eigen/Geometry>

#include "core/messages.h"
#include "core/sensors/lidar3d.h"
#include "core/settings.h"

namespace patrol::io {

/// Slice of a point cloud that becomes a planar scan, as in the ROS package pointcloud_to_laserscan.
struct CloudSliceSettings {
  double min_height_m = -0.2;  ///< minimum height of a point above the lidar, in the level frame
  double max_height_m = 0.5;
  int num_beams = 720;  ///< number of beams of one revolution

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_height_m", self.min_height_m, between(-100.0, 100.0));
    visit("max_height_m", self.max_height_m, between(-100.0, 100.0));
    visit("num_beams", self.num_beams, between(36, 3600));
  }
};

/// Returns the nearest point of the slice in each of `num_beams` sectors of the azimuth, as horizontal distance; NaN in
/// sectors without a point. `R_level_lidar`: lidar without the yaw of its mount.
///
/// If the cloud has times and its azimuth turns in one direction, as that of a spinning lidar, the beams are in the
/// order of the rotation with their time increment. Otherwise they begin at -180 degrees and have no times.
LaserScan planar_slice(const PointCloud& cloud, const Eigen::Quaterniond& R_level_lidar,
                       const CloudSliceSettings& settings);

}  // namespace patrol::io
