#pragma once

#include <string>

#include "core/settings.h"
#include "slam/motion_model_settings.h"
#include "slam/particle_filter_components.h"
#include "slam/range_update_settings.h"
#include "slam/scan_integration_settings.h"
#include "slam/scan_matcher_settings.h"

namespace patrol::slam {

struct GridSlamSettings {
  // Map representation.
  double resolution_m = 0.05;   ///< side of a cell of the map
  double max_extent_m = 400.0;  ///< side of the mapped square around the origin
  /// Minimum number of hits of an occupied cell of the published map; cells with fewer are outliers.
  int min_hits_occupied = 2;
  /// Minimum ratio of hits to hits plus passes of an occupied cell of the published map; below it the cell was occupied
  /// by a moving object.
  double min_occupied_hit_ratio = 0.5;
  // Map updates.
  double keyframe_distance_m = 0.5;  ///< distance after which a new keyframe begins
  double keyframe_angle_rad = 0.12;  ///< rotation after which a new keyframe begins
  /// Tilt above which scans are neither matched nor integrated, for example on a ramp between inclined walls.
  double max_tilt_rad = 1.6;
  /// Number of scans from the first on that are all keyframes, because the map heading depends on them.
  int initial_keyframes = 25;
  // Filter; the cost is proportional to the number of particles.
  int particles = 8;                  ///< number of particles
  double likelihood_tempering = 0.2;  ///< tempering factor: fraction of the points with independent errors (proposal.h)
  /// Proposal of the filter: scan_match, or motion, which samples from odometry only, as in FastSLAM.
  std::string proposal = "scan_match";
  /// Optimizer applied to the odometry samples, with the resampler of its source; only with `proposal: motion`.
  std::string optimizer = "none";
  /// Effective sample size, relative to the number of particles, below which the filter resamples.
  double resample_threshold = 0.5;
  MotionModelSettings motion;
  RangeUpdateSettings ranges;
  ScanMatcherSettings matching;
  ScanIntegrationSettings integration;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.01, 1.0));
    visit("max_extent_m", self.max_extent_m, between(1.0, 5000.0));
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_occupied_hit_ratio", self.min_occupied_hit_ratio, between(0.0, 1.0));
    visit("keyframe_distance_m", self.keyframe_distance_m, between(0.0, 10.0));
    visit("keyframe_angle_rad", self.keyframe_angle_rad, between(0.0, 3.2));
    visit("max_tilt_rad", self.max_tilt_rad, between(0.0, 1.6));
    visit("initial_keyframes", self.initial_keyframes, between(1, 1000));
    visit("particles", self.particles, between(1, 10000));
    visit("likelihood_tempering", self.likelihood_tempering, between(0.0, 1.0));
    visit("proposal", self.proposal, one_of({"scan_match", "motion"}));
    visit("optimizer", self.optimizer, one_of(optimizers()));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
    visit("motion", self.motion);
    visit("ranges", self.ranges);
    visit("matching", self.matching);
    visit("integration", self.integration);
  }
};

}  // namespace patrol::slam
