#pragma once

#include <optional>

#include "slam/graph/likelihood_pyramid.h"
#include "slam/submaps/effective_neighbor_icp.h"
#include "slam/submaps/submap_descriptor.h"
#include "slam/submaps/submap_surfaces_settings.h"

namespace patrol::slam {

/// Representations of a submap for comparison and matching, in submap.
struct SubmapSurfaces {
  SubmapDescriptor descriptor;
  IcpPoints points;
  LikelihoodPyramid pyramid;
};

/// Returns none if there are too few surface points.
std::optional<SubmapSurfaces> describe_surfaces(const GridMap& map, const SubmapSurfaceSettings& settings);

}  // namespace patrol::slam
