#pragma once

#include <map>
#include <utility>

#include <mrpt/maps/CSimplePointsMap.h>

#include "core/frames.h"
#include "core/sensors/registry.h"

namespace mrpt_stack {

using patrol::Pose2;
using patrol::Time;

/// Memory of obstacles below the plane of the lidar, from the depth camera.
class LowObstacles {
 public:
  /// `ground_m`: height of the ground in body.
  LowObstacles(const patrol::Pose3& T_body_camera, double ground_m)
      : T_body_camera_(T_body_camera), ground_m_(ground_m) {}

  void add(const patrol::DepthImage& image, const Pose2& T_odom_body);
  /// Adds the remembered points to those of a scan, in body.
  void append_to(mrpt::maps::CSimplePointsMap& points, Time now, const Pose2& T_odom_body);

 private:
  patrol::Pose3 T_body_camera_;
  double ground_m_;
  std::map<std::pair<int, int>, Time> last_seen_;  ///< time of the last point by cell, in odom
};

}  // namespace mrpt_stack
