#pragma once

#include <mujoco/mujoco.h>

#include "score/localizability.h"
#include "sim/ideal_scan.h"
#include "sim/sensors/lidar.h"

namespace patrol::app {

/// Localizability of a single lidar scan, anywhere in a static world without static obstacles, pedestrians and
/// vehicles. The lidar is assumed level, with a full field of view and a return from every surface within its range.
/// Its noise is that of the sensor model, but at least 1 mm.
class LocalizabilityOracle {
 public:
  /// `world` must outlive the object. `height_m`: height of the lidar, in world.
  LocalizabilityOracle(const mjModel& world, const LidarSettings& lidar, double height_m);

  score::Localizability at(const Eigen::Vector2d& p_world_m) const;

 private:
  sim::LidarScene scene_;
  double height_m_;
  sim::IdealScanSettings scan_;
  score::BeamNoise noise_;
};

}  // namespace patrol::app
