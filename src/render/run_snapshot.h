#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/ground_truth.h"
#include "core/grid.h"
#include "core/sensors/registry.h"

namespace patrol::render {

/// What a log has told by an instant, ready to be drawn. Points are m, in world; estimates are brought there
/// as a surveyor would, with map and world joined at the start.
struct RunSnapshot {
  SimState state;
  Pose3 T_world_body;  ///< true
  Pose2 T_world_map;
  Pose2 T_map_body;                             ///< estimated
  std::vector<Eigen::Vector3d> true_path;       ///< on the ground
  std::vector<Eigen::Vector3d> estimated_path;  ///< on the ground
  std::vector<Eigen::Vector3d> planned_path;    ///< on the ground
  std::vector<Eigen::Vector3d> scan;            ///< hits, from where the robot believed to be
  std::vector<Pose2> particles;                 ///< in map
  std::shared_ptr<const OccupancyGrid> map;     ///< in map; null before the first
  Pose2 T_true_estimate;                        ///< the newest estimate of the level body, in the true one of that instant
  double travelled_m = 0.0;
  std::optional<GasReading> gas;                ///< the newest; none without a methane meter
  bool is_driving = false;  ///< on tracks, and not walking
  std::string event;      ///< the newest one's text
  bool is_alarm = false;  ///< that event is one
};

}  // namespace patrol::render
