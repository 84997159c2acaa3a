#pragma once

#include <vector>

#include "core/grid.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "stack/output/stack_output.h"

namespace patrol::stack {

/// UWB range with the odometry pose at its stamp.
struct RangeWithOdometry {
  UwbRange range;
  Pose3 T_odom_body;
  double height_above_ground_m = 0.0;  ///< height of the body's origin
};

/// Interface of a localizer: pose of the body in `map` from level scans, odometry and UWB ranges.
class Localizer {
 public:
  virtual ~Localizer() = default;

  virtual void add(const RangeWithOdometry& range) = 0;
  /// Corrects the pose by a scan and publishes the estimate with its diagnostics. `T_odom_body` is at the scan's stamp.
  virtual PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) = 0;

  /// Returns the present pose estimates of all scans, [scan]; empty for a fixed map, whose poses do not change.
  virtual std::vector<Pose2> path() const { return {}; }
  virtual OccupancyGrid map() = 0;
  /// Returns whether the map grows with every scan.
  virtual bool is_mapping() const = 0;
  /// Returns whether localization has reported failure.
  virtual bool is_lost() const = 0;
  /// Returns whether the pose is known: at once for a localizer that defines the map's origin, after the first
  /// confident scan for others.
  virtual bool has_pose() const = 0;

  /// Ends the mapping; the map is fixed from then on. Ignored by localizers that do not switch.
  virtual void finish_map(const PoseEstimate&) {}
  /// Restarts near a pose, or anywhere on the map. Ignored by localizers that make the map.
  virtual void set_initial_pose(const Pose2& /*T_map_body*/, const Eigen::Matrix3d& /*covariance*/) {}
  virtual void start_global_localization() {}
  /// Moves the UWB anchors in `map`, above the ground of map. Ignored by localizers without ranges.
  virtual void set_anchors(const std::vector<UwbAnchor>& /*anchors_in_map*/) {}
};

}  // namespace patrol::stack
