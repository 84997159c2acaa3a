#include "slam/submaps/submap_surfaces.h"

#include <utility>

#include "slam/surface_points.h"

namespace patrol::slam {
namespace {

constexpr int kSurfacePyramidLevels = 7;

}  // namespace

std::optional<SubmapSurfaces> describe_surfaces(const GridMap& map, const SubmapSurfaceSettings& settings) {
  std::vector<Eigen::Vector2d> points = surface_points(map);
  if (static_cast<int>(points.size()) < settings.min_points) return std::nullopt;
  SubmapShape shape = describe_submap(points, map, settings.shape);
  std::vector<Eigen::Vector2d> facings = facings_of(points, map, settings.facing_radius_m);
  return SubmapSurfaces{.shape = std::move(shape), .points = IcpPoints(std::move(points), settings.icp, std::move(facings)), .pyramid = LikelihoodPyramid(map, settings.pyramid_cell_m, kSurfacePyramidLevels)};
}

}  // namespace patrol::slam
