#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "core/ground_truth.h"
#include "core/sensors/registry.h"

namespace patrol::render {

inline constexpr double kLiningMarkRadius_m = 0.4;

/// Finding of the lining inspection, marked on the lining.
struct LiningMark {
  /// closed line on the lining around the maximum displacement, with the radius kLiningMarkRadius_m
  std::vector<Eigen::Vector3d> outline;
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();
  std::string text;  ///< ring and displacement
  bool is_alarm = false;
};

/// Drawable state of a run at one time of its log. Points are in world, m. Estimates are transformed to world by
/// `T_world_map`, the alignment at the start.
struct RunSnapshot {
  SimState state;
  Pose3 T_world_body;  ///< ground truth
  Pose2 T_world_map;
  std::optional<Pose2> T_map_body;              ///< newest estimate; none before the first
  std::vector<Eigen::Vector3d> true_path;       ///< ground truth path on the ground
  std::vector<Eigen::Vector3d> estimated_path;  ///< estimated path on the ground
  std::vector<Eigen::Vector3d> planned_path;    ///< planned path on the ground
  std::vector<Eigen::Vector3d> scan;            ///< scan hits at the estimated pose
  std::vector<Pose2> particles;                 ///< in map
  std::shared_ptr<const OccupancyGrid> map;     ///< in map; null before the first map
  /// Newest estimate of the level body relative to its true pose at that stamp; none before the first.
  std::optional<Pose2> T_true_estimate;
  double traveled_m = 0.0;
  std::optional<GasReading> gas;  ///< newest reading; none without a methane meter
  bool is_driving = false;        ///< robot on tracks or wheels, not a walking one
  std::vector<LiningMark> lining_marks;
  std::string event;      ///< text of the newest event
  bool is_alarm = false;  ///< the newest event is an alarm
};

}  // namespace patrol::render
