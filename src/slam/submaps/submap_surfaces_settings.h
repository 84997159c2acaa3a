#pragma once

#include "core/settings.h"
#include "slam/submaps/effective_neighbor_icp_settings.h"
#include "slam/submaps/submap_descriptor_settings.h"

namespace patrol::slam {

struct SubmapSurfaceSettings {
  int min_points = 30;  ///< minimum number of surface points of a submap that is compared with others
  SubmapDescriptorSettings descriptor;
  IcpSettings icp;
  double free_space_radius_m = 0.2;  ///< radius of the free cells that determine the free-space normal of a point
  double pyramid_cell_m = 0.1;       ///< side of a cell of the finest level of the pyramid

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_points", self.min_points, between(3, 100000));
    visit("descriptor", self.descriptor);
    visit("icp", self.icp);
    visit("free_space_radius_m", self.free_space_radius_m, between(0.05, 2.0));
    visit("pyramid_cell_m", self.pyramid_cell_m, between(0.02, 1.0));
  }
};

}  // namespace patrol::slam
