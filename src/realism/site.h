#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "sim/lidar_scene.h"
#include "sim/mujoco.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::realism {

/// Surface that a beam without errors meets.
struct SurfaceHit {
  double range_m = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit normal, in site, oriented toward the lidar
  double reflectivity = 0.0;                         ///< reflectivity as the lidar model uses it: at least 0.02
  bool is_glass = false;
};

/// Surfaces of a site for beams without errors. Moving bodies are at their initial poses.
class Site {
 public:
  /// Loads the world of an MJCF file. Throws InputError.
  explicit Site(const std::filesystem::path& world_xml);
  explicit Site(sim::ModelPtr world);

  /// Returns the first surface along the unit vector `direction`, both in site; none beyond `max_range_m`.
  std::optional<SurfaceHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                 double max_range_m) const;

  const sim::LidarScene& scene() const { return *scene_; }
  const mjModel& model() const { return *world_; }

 private:
  sim::ModelPtr world_;
  std::unique_ptr<sim::LidarScene> scene_;
  std::vector<sim::SurfaceOptics> surfaces_;  ///< [geom]
};

}  // namespace patrol::realism
