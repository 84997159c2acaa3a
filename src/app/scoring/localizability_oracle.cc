#include "app/scoring/localizability_oracle.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/angles.h"

namespace patrol::app {
namespace {

/// Noise of one of `num_rays` rays, which carries the information of all of the lidar's beams that it represents.
score::BeamNoise noise_of(const LidarSettings& lidar, int num_rays) {
  constexpr double kMinStd_m = 0.001;
  const double quantum_m = lidar.range_quantization_m;
  const double range_std_m =
      std::sqrt(lidar.range_noise_std_m * lidar.range_noise_std_m + quantum_m * quantum_m / 12.0);
  const double beams_per_ray = lidar.beams * 360.0 / lidar.fov_deg / num_rays;
  return {.range_std_m = std::max(range_std_m, kMinStd_m) / std::sqrt(beams_per_ray),
          .direction_std_rad = to_rad(lidar.angle_noise_std_deg) / std::sqrt(beams_per_ray)};
}

}  // namespace

LocalizabilityOracle::LocalizabilityOracle(const mjModel& world, const LidarSettings& lidar, double height_m)
    : scene_(world),
      height_m_(height_m),
      scan_{.range_max_m = lidar.range_max_m, .max_incidence_deg = lidar.max_incidence_deg},
      noise_(noise_of(lidar, scan_.beams)) {}

score::Localizability LocalizabilityOracle::at(const Eigen::Vector2d& p_world_m) const {
  return score::localizability(sim::ideal_scan(scene_, {p_world_m.x(), p_world_m.y(), height_m_}, scan_), noise_);
}

}  // namespace patrol::app
