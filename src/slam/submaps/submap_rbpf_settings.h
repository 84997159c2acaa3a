#pragma once

#include "core/settings.h"
#include "slam/graph/pose_graph_solver_settings.h"
#include "slam/graph/scan_tracker_settings.h"
#include "slam/submaps/submap_builder_settings.h"
#include "slam/submaps/submap_constraint_finder_settings.h"
#include "slam/submaps/submap_surfaces_settings.h"

namespace patrol::slam {

struct SubmapRbpfSettings {
  ScanTrackerSettings scan_odometry;
  SubmapBuilderSettings submaps;
  SubmapSurfaceSettings surfaces;
  SubmapConstraintSettings constraints;
  // Odometry drift over a submap, for the prediction of loop closures.
  double drift_std_m_per_m = 0.003;      ///< drift of the position over a submap, per distance
  double drift_std_rad_per_m = 0.0005;   ///< drift of the yaw over a submap, per distance
  double drift_std_rad_per_rad = 0.005;  ///< drift of the yaw over a submap, per rotation
  int max_candidates = 8;                ///< maximum number of older submaps compared with each new one, nearest first
  double likelihood_tempering = 0.2;     ///< tempering factor: fraction of the matched points with independent errors
  /// Standard deviation of the systematic error of a match, independent of the number of points.
  double constraint_std_m = 0.02;
  /// Standard deviation of the systematic yaw error of a match, independent of the number of points.
  double constraint_std_rad = 0.002;
  /// Optimization with a narrow kernel: each submap has many constraints, of which only a few need to be inliers.
  PoseGraphSolverSettings solver = {.max_iterations = 50, .robust_loop_closures = true, .loop_closure_loss_scale = 0.3};
  int min_hits_occupied = 2;  ///< minimum number of hits of an occupied cell of the published map
  /// Minimum ratio of hits to hits plus passes of an occupied cell of the published map.
  double min_occupied_hit_ratio = 0.3;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("scan_odometry", self.scan_odometry);
    visit("submaps", self.submaps);
    visit("surfaces", self.surfaces);
    visit("constraints", self.constraints);
    visit("drift_std_m_per_m", self.drift_std_m_per_m, between(1e-6, 10.0));
    visit("drift_std_rad_per_m", self.drift_std_rad_per_m, between(1e-6, 10.0));
    visit("drift_std_rad_per_rad", self.drift_std_rad_per_rad, at_least(0.0));
    visit("max_candidates", self.max_candidates, between(0, 10000));
    visit("likelihood_tempering", self.likelihood_tempering, between(0.0, 1.0));
    visit("constraint_std_m", self.constraint_std_m, between(1e-5, 1.0));
    visit("constraint_std_rad", self.constraint_std_rad, between(1e-6, 1.0));
    visit("solver", self.solver);
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_occupied_hit_ratio", self.min_occupied_hit_ratio, between(0.0, 1.0));
  }
};

}  // namespace patrol::slam
