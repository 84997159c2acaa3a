#pragma once

#include <filesystem>
#include <vector>

#include "core/ground_truth.h"
#include "core/inspection_result.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/trajectory.h"

namespace patrol::app {

/// What a run's log says that its score is made of.
struct RunRecord {
  Trajectory T_map_body;    ///< the stack's estimate
  std::vector<Eigen::Matrix3d> covariances;  ///< its own, [pose of T_map_body]: of x, y, yaw in map; m, m, rad
  Trajectory T_map_body_by_ranges;  ///< its second opinion, if it has one
  Trajectory T_odom_body;
  Trajectory T_world_body;  ///< the truth
  std::vector<Event> events;
  std::vector<LocalizationTrust> trusts;
  std::vector<RemoteCommand> remote;
  std::vector<Collision> collisions;
  std::vector<LiningResult> linings;
  std::vector<WaterResult> waters;
  std::size_t num_paths = 0;  ///< that the navigation planned
  OccupancyGrid map;        ///< the last one
  bool is_complete = false; ///< the log has its end

  std::size_t num_events(EventKind kind) const;
  bool has_event(EventKind kind) const { return num_events(kind) > 0; }
  /// Whether the run lasted until the stack had an estimate and a map.
  bool has_estimate() const;
};

/// Throws InputError when the log is damaged, or cut off before the first truth.
RunRecord read_run_record(const std::filesystem::path& log_mcap);

}  // namespace patrol::app
