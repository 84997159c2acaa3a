#include "realism/site.h"

#include <algorithm>
#include <utility>

namespace patrol::realism {
namespace {

sim::ModelPtr load_world(const std::filesystem::path& world_xml) {
  const sim::SpecPtr spec = sim::load_spec(world_xml.string());
  return sim::compile(*spec, world_xml.string());
}

}  // namespace

Site::Site(const std::filesystem::path& world_xml) : Site(load_world(world_xml)) {}

Site::Site(sim::ModelPtr world)
    : world_(std::move(world)),
      scene_(std::make_unique<sim::LidarScene>(*world_)),
      surfaces_(sim::surface_optics(*world_)) {}

std::optional<SurfaceHit> Site::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                     double max_range_m) const {
  constexpr double kMinReflectivity = 0.02;  // of the lidar model (sim/sensors/lidar.cc)
  const std::optional<sim::RayHit> hit = scene_->cast(origin, direction, max_range_m, sim::kRayScenery);
  if (!hit) return std::nullopt;
  const sim::SurfaceOptics& surface = surfaces_[static_cast<std::size_t>(hit->geom)];
  return SurfaceHit{.range_m = hit->distance_m,
                    .normal = hit->normal,
                    .reflectivity = std::max(kMinReflectivity, static_cast<double>(surface.reflectivity)),
                    .is_glass = surface.is_glass};
}

}  // namespace patrol::realism
