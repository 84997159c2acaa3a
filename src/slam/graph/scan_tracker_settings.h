#pragma once

#include "core/settings.h"
#include "slam/motion_model_settings.h"
#include "slam/scan_integration_settings.h"
#include "slam/scan_matcher_settings.h"

namespace patrol::slam {

struct ScanTrackerSettings {
  double resolution_m = 0.05;         ///< side of a cell of the tracker's maps
  double max_extent_m = 4000.0;       ///< side of the mapped square around the start
  double keyframe_distance_m = 0.25;  ///< distance after which a new keyframe begins
  double keyframe_angle_rad = 0.15;   ///< rotation after which a new keyframe begins
  int min_hits = 60;           ///< number of returns below which a keyframe also contains the scans since the last one
  bool groups_scans = false;   ///< whether every keyframe contains the scans since the last one
  int initial_keyframes = 10;  ///< number of scans from the first on that are all keyframes
  int submap_keyframes = 60;   ///< number of keyframes per map; consecutive maps overlap by half
  /// Tempering factor: fraction of the points with independent errors. It is larger for scans of few, distant points.
  double likelihood_tempering = 0.2;
  /// Fastest motion of the robot, which limits the search for a scan that the odometry prediction does not match.
  double max_speed_mps = 1.5;
  /// Fastest rotation of the robot, which limits the search for a scan that the odometry prediction does not match.
  double max_turn_rate_radps = 2.0;
  /// Uncertainty of the motion between scans; the defaults suit uncalibrated wheel odometry.
  MotionModelSettings motion{.longitudinal_std_m_per_m = 0.05,
                             .lateral_std_m_per_m = 0.03,
                             .yaw_std_rad_per_rad = 0.1,
                             .yaw_std_rad_per_m = 0.03,
                             .yaw_std_rad_per_s = 0.003,
                             .min_std_m = 0.005,
                             .min_std_rad = 0.005};
  ScanMatcherSettings matching;
  ScanIntegrationSettings integration;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.01, 1.0));
    visit("max_extent_m", self.max_extent_m, between(1.0, 20000.0));
    visit("keyframe_distance_m", self.keyframe_distance_m, between(0.0, 10.0));
    visit("keyframe_angle_rad", self.keyframe_angle_rad, between(0.0, 3.2));
    visit("min_hits", self.min_hits, between(0, 100000));
    visit("groups_scans", self.groups_scans);
    visit("initial_keyframes", self.initial_keyframes, between(1, 1000));
    visit("submap_keyframes", self.submap_keyframes, between(4, 10000));
    visit("likelihood_tempering", self.likelihood_tempering, between(0.0, 1.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.0, 100.0));
    visit("max_turn_rate_radps", self.max_turn_rate_radps, between(0.0, 20.0));
    visit("motion", self.motion);
    visit("matching", self.matching);
    visit("integration", self.integration);
  }
};

}  // namespace patrol::slam
