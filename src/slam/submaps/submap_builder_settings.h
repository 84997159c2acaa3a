#pragma once

#include "core/settings.h"
#include "slam/rbpf/grid_slam_settings.h"

namespace patrol::slam {

struct SubmapBuilderSettings {
  double max_distance_m = 12.0;  ///< distance traveled at which a submap is full
  int max_keyframes = 150;       ///< number of keyframes at which a submap is full
  GridSlamSettings filter = submap_filter_settings();

  /// Filter settings for submaps of a few meters on scan-to-scan odometry: few particles and small motion noise.
  static GridSlamSettings submap_filter_settings();

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_distance_m", self.max_distance_m, between(1.0, 1000.0));
    visit("max_keyframes", self.max_keyframes, between(2, 100000));
    visit("filter", self.filter);
  }
};

}  // namespace patrol::slam
