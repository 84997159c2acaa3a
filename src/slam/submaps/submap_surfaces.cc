#include "slam/submaps/submap_surfaces.h"

#include <utility>

#include "slam/surface_points.h"

namespace patrol::slam {
namespace {

constexpr int kPyramidLevels = 7;

}  // namespace

std::optional<SubmapSurfaces> describe_surfaces(const GridMap& map, const SubmapSurfaceSettings& settings) {
  std::vector<Eigen::Vector2d> points = surface_points(map);
  if (static_cast<int>(points.size()) < settings.min_points) return std::nullopt;
  SubmapShape shape = describe_submap(points, map, settings.shape);
  return SubmapSurfaces{.shape = std::move(shape), .points = IcpTarget(std::move(points), settings.icp), .pyramid = LikelihoodPyramid(map, settings.pyramid_cell_m, kPyramidLevels)};
}

}  // namespace patrol::slam
