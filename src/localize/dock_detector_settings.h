#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the detection of the charging post in a scan (dock_detector.h).
struct DockDetectorSettings {
  /// Search range to either side of the expected position of the post, longitudinal and lateral.
  double search_m = 0.3;
  double search_rad = 0.2;     ///< search range to either side of the expected heading of the post
  double range_std_m = 0.025;  ///< standard deviation of the range of a beam on the post
  /// Width of the free space required next to the ends of the post: hits in it count against the detection.
  double end_clearance_m = 0.15;
  double min_inlier_ratio = 0.75;  ///< minimum inlier ratio of the beams around a detected post
  double max_rms_m = 0.04;   ///< maximum root mean square distance of the returns from the outline of a detected post
  int min_beams = 25;        ///< minimum number of beams on a detected post
  double max_range_m = 4.0;  ///< maximum distance between the lidar and the expected post for a search

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("search_m", self.search_m, between(0.02, 1.0));
    visit("search_rad", self.search_rad, between(0.02, 0.8));
    visit("range_std_m", self.range_std_m, between(0.001, 0.2));
    visit("end_clearance_m", self.end_clearance_m, between(0.0, 1.0));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.1, 1.0));
    visit("max_rms_m", self.max_rms_m, between(0.005, 0.5));
    visit("min_beams", self.min_beams, between(5, 10000));
    visit("max_range_m", self.max_range_m, between(0.5, 50.0));
  }
};

}  // namespace patrol::localize
