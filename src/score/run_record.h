#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/calibration/calibration_estimate.h"
#include "core/ground_truth.h"
#include "core/inspection_result.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/site/site_registration.h"
#include "core/trajectory.h"
#include "score/calibration_score.h"

namespace patrol::score {

/// Messages of a run's log that its score is computed from.
struct RunRecord {
  Trajectory T_map_body;                            ///< estimate of the stack
  std::vector<Time> T_map_body_received;            ///< [pose of T_map_body]: log time
  std::vector<Eigen::Matrix3d> covariances;         ///< [pose of T_map_body]: of x, y, yaw in map; m, m, rad
  Trajectory T_map_body_by_ranges;                  ///< estimate by odometry and UWB ranges, if the stack has one
  std::vector<Time> T_map_body_by_ranges_received;  ///< [pose of T_map_body_by_ranges]: log time
  Trajectory T_odom_body;
  std::vector<Time> T_odom_body_received;       ///< [pose of T_odom_body]: log time
  Trajectory T_world_body;                      ///< ground truth
  std::vector<SiteRegistration> registrations;  ///< pose of map in site, by stamp; empty in older logs
  std::vector<GyroReading> gyro;
  AsBuiltTruth as_built;                           ///< ground truth; empty for a nominal robot
  std::vector<TrackReading> tracks;                ///< counts of a tracked robot
  std::optional<CalibrationEstimate> calibration;  ///< newest, if the stack estimates its calibration
  std::vector<Event> events;
  bool has_fall_report = false;                     ///< whether the firmware reported a fall
  std::vector<LocalizationConfidence> confidences;  ///< confidences in ascending stamp order
  std::vector<TeleopCommand> teleop;
  std::vector<Collision> collisions;
  std::vector<LiningResult> linings;
  std::vector<WaterResult> waters;
  std::size_t num_paths = 0;    ///< paths with poses that the navigation planned
  bool has_empty_path = false;  ///< whether a path without poses was published
  OccupancyGrid map;            ///< newest map
  bool has_empty_map = false;   ///< whether the newest map was published without cells
  bool is_complete = false;     ///< whether the log has its end

  std::size_t num_events(EventKind kind) const;
  bool has_event(EventKind kind) const { return num_events(kind) > 0; }
  /// Whether the stack published enough pose estimates to score them. It need not publish odometry or a map.
  bool has_estimate() const;
  bool has_map() const;
};

}  // namespace patrol::score
