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
  SubmapDescriptor descriptor = describe_submap(points, map, settings.descriptor);
  std::vector<Eigen::Vector2d> free_space_normals =
      estimate_free_space_normals(points, map, settings.free_space_radius_m);
  return SubmapSurfaces{.descriptor = std::move(descriptor),
                        .points = IcpPoints(std::move(points), settings.icp, std::move(free_space_normals)),
                        .pyramid = LikelihoodPyramid(map, settings.pyramid_cell_m, kSurfacePyramidLevels)};
}

}  // namespace patrol::slam
