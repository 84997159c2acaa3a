#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "core/inspection_result.h"
#include "core/trajectory.h"

namespace patrol::score {

/// A body of water that was really there.
struct TrueWater {
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// A body that the robot has reported, beside the one it is about.
struct WaterFinding {
  std::string station;
  std::optional<std::size_t> body;  ///< index; none: a false alarm, and there is nothing to say below
  double position_error_m = 0.0;    ///< in space
  double ahead_error_m = 0.0;       ///< along the true way from the antenna to the body; positive: reported too far away
  double radius_error_m = 0.0;
  bool distance_holds = false;      ///< the interval of the distance holds the truth
  bool radius_holds = false;
  bool position_holds = false;      ///< the truth is within the 95 % ellipsoid of the position
};

struct WaterScore {
  int stations = 0;  ///< where soundings were made
  int bodies = 0;
  int found = 0;     ///< bodies that a finding is about
  int missed = 0;
  int false_alarms = 0;
  std::vector<WaterFinding> findings;
};

/// A finding is about the nearest body within `max_distance_m`; one with none there is false. Results are placed by where the robot stood by
/// its own estimate, in the plane, and by its true height (it does not estimate that); distances are from the true antenna, at
/// `p_body_antenna` on the robot. Nothing is missed at a station that was never sounded: with no result at all, no body is.
WaterScore water_score(const std::vector<WaterResult>& results, const std::vector<TrueWater>& bodies, const Pose2& T_world_map,
                       const Trajectory& T_world_body, const Eigen::Vector3d& p_body_antenna, double max_distance_m = 6.0);

}  // namespace patrol::score
