#pragma once

#include <vector>

namespace mrpt_stack {

/// Parameters that differ between robots. The defaults are those of the tracked robot in the tunnel, chosen with
/// seed 1.
struct NavigationSettings {
  double speed_mps = 0.6;
  double yaw_rate_radps = 0.6;
  double margin_m = 0.08;                        ///< of the footprint's corners
  double ref_distance_m = 5.0;                   ///< length of the trajectories
  double secure_distance_end = 0.2;              ///< free part of a trajectory from which on the speed is not reduced
  std::vector<double> planner_radii_m = {0.65};  ///< radii of the planner's disk, in the order of their trial
  double min_occupancy = 0.5;                    ///< occupancy from which on a cell blocks the planner
  double carrot_m = 3.0;                         ///< distance of the target on the path
  bool is_carrot_visible = false;                ///< the target is not beyond the first bend of the path
  double undocking_m = 1.5;                      ///< way backward at the start
  double turning_radius_m = 0.0;                 ///< free radius that a turn on the spot needs
  bool has_reverse = false;                      ///< backward arcs are among the trajectories
};

}  // namespace mrpt_stack
