#pragma once

#include <optional>

#include "core/settings.h"
#include "slam/graph/likelihood_pyramid.h"
#include "slam/submaps/effective_neighbour_icp.h"
#include "slam/submaps/submap_shape.h"

namespace patrol::slam {

struct SubmapSurfaceSettings {
  int min_points = 30;  ///< of surface: what has fewer is not compared with others
  SubmapShapeSettings shape;
  IcpSettings icp;
  double pyramid_cell_m = 0.1;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_points", self.min_points, between(3, 100000));
    visit("shape", self.shape);
    visit("icp", self.icp);
    visit("pyramid_cell_m", self.pyramid_cell_m, between(0.02, 1.0));
  }
};

/// What a submap is compared and matched by; in submap.
struct SubmapSurfaces {
  SubmapShape shape;
  IcpTarget points;
  LikelihoodPyramid pyramid;
};

/// None if next to nothing was seen.
std::optional<SubmapSurfaces> describe_surfaces(const GridMap& map, const SubmapSurfaceSettings& settings);

}  // namespace patrol::slam
