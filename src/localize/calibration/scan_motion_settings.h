#pragma once

#include "core/settings.h"
#include "slam/scan_integration_settings.h"
#include "slam/scan_matcher_settings.h"

namespace patrol::localize {

/// Settings of the scan matching that measures the lidar's motion for the calibration.
struct ScanMotionSettings {
  double resolution_m = 0.05;        ///< resolution of the local maps of the calibration
  double map_length_m = 6.0;         ///< distance traveled after which a new local map starts
  double keyframe_distance_m = 0.3;  ///< distance traveled after which a scan is added to the local map
  double keyframe_angle_rad = 0.3;   ///< rotation after which a scan is added to the local map
  double min_inlier_ratio = 0.6;     ///< minimum inlier ratio of a matched scan
  double start_std_m = 0.1;          ///< standard deviation of the weak position prior around the odometry prediction
  double start_std_rad = 0.05;       ///< standard deviation of the weak yaw prior around the odometry prediction
  /// Tempering factor of the information of a match: fraction of the points with independent errors.
  double likelihood_tempering = 0.2;
  double match_std_m = 0.001;     ///< standard deviation of the systematic position error of a match
  double match_std_rad = 0.0002;  ///< standard deviation of the systematic yaw error of a match
  slam::ScanMatcherSettings matching{.max_points = 300, .point_spacing_m = 0.1};
  slam::ScanIntegrationSettings integration{.free_ray_stride = 12};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.01, 1.0));
    visit("map_length_m", self.map_length_m, between(0.5, 1000.0));
    visit("keyframe_distance_m", self.keyframe_distance_m, between(0.01, 10.0));
    visit("keyframe_angle_rad", self.keyframe_angle_rad, between(0.01, 3.2));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.0, 1.0));
    visit("start_std_m", self.start_std_m, between(1e-3, 10.0));
    visit("start_std_rad", self.start_std_rad, between(1e-3, 3.0));
    visit("likelihood_tempering", self.likelihood_tempering, between(1e-3, 1.0));
    visit("match_std_m", self.match_std_m, between(1e-5, 1.0));
    visit("match_std_rad", self.match_std_rad, between(1e-6, 1.0));
    visit("matching", self.matching);
    visit("integration", self.integration);
  }
};

}  // namespace patrol::localize
