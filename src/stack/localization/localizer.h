#pragma once

#include <vector>

#include "core/grid.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/state/state_archive_fwd.h"
#include "core/uwb.h"
#include "slam/mapped_range.h"
#include "slam/position_measurement.h"
#include "stack/output/stack_output.h"

namespace patrol::stack {

/// UWB range with the odometry pose at its stamp.
struct RangeWithOdometry {
  UwbRange range;
  Pose3 T_odom_body;
  double height_m = 0.0;  ///< height of the body's origin above the ground at the start
};

/// Interface of a localizer: pose of the body in `map` from level scans, odometry and UWB ranges.
class Localizer {
 public:
  virtual ~Localizer() = default;

  virtual void add(const RangeWithOdometry& range) = 0;
  /// Adds a position of the GNSS antenna in map, as the surveyed start places it. Ignored by localizers on a fixed map.
  virtual void add(const slam::PositionMeasurement& /*position*/) {}
  /// Corrects the pose by a scan and publishes the estimate with its diagnostics. `T_odom_body` is at the scan's stamp.
  virtual PoseEstimate update(const LevelScan& scan, const Pose2& T_odom_body, StackOutput& output) = 0;

  /// Returns the present pose estimates of the scans with which the map was made, [scan]; empty for a given map.
  virtual std::vector<Pose2> path() const { return {}; }
  virtual OccupancyGrid map() = 0;
  /// Returns the UWB ranges along the path of the mapping; empty for a given map.
  virtual std::vector<slam::MappedRange> mapped_ranges() const { return {}; }
  /// Returns whether the map grows with every scan.
  virtual bool is_mapping() const = 0;
  /// Returns whether localization has reported failure.
  virtual bool is_lost() const = 0;
  /// Returns whether the pose is known: at once for a localizer that defines the map's origin, after the first
  /// confident scan for others.
  virtual bool has_pose() const = 0;

  /// Ends the mapping with its final optimization; the map is fixed from then on. `pose`: present pose. Returns the
  /// motion of the map at the newest scan, p_map = T_map_old * p_old. Does nothing where the map is given or complete.
  virtual Pose2 finish_map(const PoseEstimate& /*pose*/) { return {}; }
  /// Restarts near a pose, or anywhere on the map. Ignored by localizers that make the map.
  virtual void set_initial_pose(const Pose2& /*T_map_body*/, const Eigen::Matrix3d& /*covariance*/) {}
  virtual void start_global_localization() {}
  /// Moves the UWB anchors in `map`, above the ground of map. Ignored by localizers without ranges.
  virtual void set_anchors(const std::vector<UwbAnchor>& /*anchors_in_map*/) {}

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& archive) = 0;
};

}  // namespace patrol::stack
