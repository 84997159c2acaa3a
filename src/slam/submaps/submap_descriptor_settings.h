#pragma once

#include "core/settings.h"
#include "slam/submaps/ndt_settings.h"

namespace patrol::slam {

struct SubmapDescriptorSettings {
  int max_points = 300;           ///< maximum number of compared points; a regular subset of larger submaps is used
  double normal_radius_m = 0.4;   ///< radius of the neighborhood whose principal axis is the direction of the wall
  double distance_bin_m = 1.0;    ///< bin width of the histogram of distances between points
  int distance_bins = 40;         ///< number of distance bins; the last one includes all larger distances
  int direction_bins = 36;        ///< number of direction bins over half a turn
  double observed_cell_m = 0.25;  ///< side of a cell of the grid of observed space
  NdtSettings ndt;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(3, 100000));
    visit("normal_radius_m", self.normal_radius_m, between(0.01, 10.0));
    visit("distance_bin_m", self.distance_bin_m, between(0.01, 100.0));
    visit("distance_bins", self.distance_bins, between(2, 10000));
    visit("direction_bins", self.direction_bins, between(4, 720));
    visit("observed_cell_m", self.observed_cell_m, between(0.05, 10.0));
    visit("ndt", self.ndt);
  }
};

}  // namespace patrol::slam
