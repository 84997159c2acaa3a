#pragma once

#include <mujoco/mujoco.h>

#include "score/localizability.h"
#include "sim/ideal_scan.h"
#include "sim/sensors/lidar.h"

namespace patrol::app {

/// What one scan of a lidar can tell, anywhere in a world as it stands, without props, people and vehicles. The lidar is taken to be level, to
/// see all around, and to get light back from every surface within its range; its noise is the real one's, but at least a millimetre.
class LocalizabilityOracle {
 public:
  /// `world` must outlive it. `height_m`: of the lidar, in world.
  LocalizabilityOracle(const mjModel& world, const LidarSettings& lidar, double height_m);

  score::Localizability at(const Eigen::Vector2d& p_world_m) const;

 private:
  sim::LidarScene scene_;
  double height_m_;
  sim::IdealScanSettings scan_;
  score::BeamNoise noise_;
};

}  // namespace patrol::app
