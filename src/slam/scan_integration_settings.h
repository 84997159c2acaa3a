#pragma once

#include "core/settings.h"

namespace patrol::slam {

/// Insertion of scans into an occupancy grid.
struct ScanIntegrationSettings {
  int free_ray_stride = 6;  ///< stride of the beams that are traced through free space: one of every N, with weight N
  /// Distance before the hit at which a free ray ends, so that it does not clear the wall.
  double free_margin_m = 0.15;
  double max_free_range_m = 30.0;  ///< maximum range of free-space updates

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("free_ray_stride", self.free_ray_stride, between(1, 1000));
    visit("free_margin_m", self.free_margin_m, between(0.0, 2.0));
    visit("max_free_range_m", self.max_free_range_m, between(0.0, 400.0));
  }
};

}  // namespace patrol::slam
