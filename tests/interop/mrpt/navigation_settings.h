#pragma once

#include <string>
#include <vector>

namespace mrpt_stack {

/// Parameters that differ between robots. The defaults are those of the tracked robot in the tunnel, chosen with
/// seed 1.
struct NavigationSettings {
  double speed_mps = 0.6;
  double yaw_rate_radps = 0.6;
  double margin_m = 0.08;       ///< distance of the footprint's corners beyond those of the robot
  double ref_distance_m = 5.0;  ///< length of the trajectories
  double resolution_m = 0.05;   ///< cell size of the trajectories' collision grids
  double full_speed = 0.2;      ///< free fraction of `ref_distance_m` from which on the speed is not reduced
  double too_close = 0.15;      ///< directions with a smaller free fraction of `ref_distance_m` are not used
  std::string score = "free_distance + nearness + 0.3 * same_as_before + toward_target";  ///< score of a trajectory
  std::vector<double> planner_radii_m = {0.65};  ///< radii of the planner's disk: the first with a path counts
  double min_occupancy = 0.5;                    ///< occupancy from which on a cell blocks the planner
  double carrot_m = 3.0;                         ///< distance of the target on the path
  double carrot_clearance_m = 0.0;  ///< minimum distance of obstacles from the line to the target, unless it is near
  double undocking_m = 1.5;         ///< distance backward from the charging post at the start
  double turning_radius_m = 0.0;    ///< free radius that a turn in place needs
  double backing_up_m = 0.0;        ///< distance backward if the navigator finds no trajectory; 0: none
};

}  // namespace mrpt_stack
