#pragma once

#include "core/grid.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "stack/output/stack_output.h"

namespace patrol::stack {

/// A UWB range with the state of odometry at its stamp.
struct RangeWithOdometry {
  UwbRange range;
  Pose3 T_odom_body;
  double height_above_ground_m = 0.0;  ///< of the body's origin
};

/// Interface of a localizer: pose of the body in `map` from level scans, odometry and UWB ranges.
class Localizer {
 public:
  virtual ~Localizer() = default;

  virtual void add(const RangeWithOdometry& range) = 0;
  /// Corrects the pose by a scan and publishes the estimate, with what belongs to it. `T_odom_body` at the scan's
  /// stamp.
  virtual PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) = 0;

  virtual OccupancyGrid map() = 0;
  /// The map grows with every scan.
  virtual bool is_mapping() const = 0;
  /// The localizer reports that it does not know the pose.
  virtual bool is_lost() const = 0;
  /// The pose is known: at once for a localizer that makes the map's origin, after the first confident scan for others.
  virtual bool knows_pose() const = 0;

  /// Ends the mapping: the map stays as it is. Ignored by localizers that do not switch.
  virtual void finish_map(const PoseEstimate&) {}
  /// Starts again near a pose, or anywhere on the map. Ignored by localizers that make the map.
  virtual void start_at(const Pose2& /*T_map_body*/, const Eigen::Matrix3d& /*covariance*/) {}
  virtual void start_anywhere() {}
};

}  // namespace patrol::stack
