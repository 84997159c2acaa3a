#pragma once

#include <cstdint>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// RTK GNSS receiver. Its status (fixed, float or none) depends on the fraction of sky visible past walls and trees.
class Gnss {
 public:
  Gnss(const GnssSettings& settings, std::uint64_t seed);

  GnssFix read(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna, Time now, std::uint64_t tick);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(error_, open_since_, was_open_);
  }

 private:
  static double open_sky_fraction(const LidarScene& scene, const Eigen::Vector3d& antenna);

  GnssSettings settings_;
  RandomStream noise_;
  Eigen::Vector3d error_ = Eigen::Vector3d::Zero();  ///< correlated error of unit variance
  Time open_since_{};
  bool was_open_ = true;
};

}  // namespace patrol::sim
