#pragma once

#include "core/messages.h"
#include "core/settings.h"
#include "slam/grid_map.h"

namespace patrol::slam {

struct ScanIntegrationSettings {
  int free_ray_stride = 6;          ///< every so many beams one is followed through the free cells, and counts for all of them
  double free_margin_m = 0.15;      ///< free rays end this much before their hit: they must not wear away the wall they hit
  double max_free_range_m = 30.0;   ///< nothing is learnt about free space beyond

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("free_ray_stride", self.free_ray_stride, between(1, 1000));
    visit("free_margin_m", self.free_margin_m, between(0.0, 2.0));
    visit("max_free_range_m", self.max_free_range_m, between(0.0, 400.0));
  }
};

/// Writes a scan, taken at `T_map_body`, into the map.
void integrate_scan(const LevelScan& scan, const Pose2& T_map_body, const ScanIntegrationSettings& settings, GridMap& map);

}  // namespace patrol::slam
