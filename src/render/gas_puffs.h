#pragma once

#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "render/scene/camera.h"
#include "render/scene/frame.h"
#include "sim/gas_plume.h"

namespace patrol::render {

/// Gaussian ball of gas.
struct Puff {
  Eigen::Vector3d p_world_m;
  double radius_m;      ///< standard deviation of the density
  double column_ppm_m;  ///< methane column through the center
};

/// Gas of a run's leaks as puffs that drift downwind, with the concentration of the simulated plume at their positions.
/// The plume is stationary: the drift only shows the wind direction.
class GasCloud {
 public:
  GasCloud() = default;
  /// Throws InputError when a leak names a site that the world does not have.
  GasCloud(const mjModel& world, const std::vector<sim::LeakSettings>& leaks, const sim::WindSettings& wind);

  bool is_empty() const { return plumes_.empty(); }
  /// Puffs at time `now_s` of the run; a leak has none before its start. `drift_m` is the distance by which the puffs
  /// have drifted.
  std::vector<Puff> puffs(double now_s, double drift_m) const;

 private:
  struct Plume {
    sim::GasPlume gas;
    Eigen::Vector3d source_m;
    double start_s;
  };
  std::vector<Plume> plumes_;
  Eigen::Vector2d downwind_ = Eigen::Vector2d::UnitX();
};

/// Draws puffs on a finished frame, occluded by objects in front of them. `depth` as in Offscreen::read_depth. A column
/// of kVeilColumn_ppm_m transmits 37 % of the background.
inline constexpr double kVeilColumn_ppm_m = 4000.0;
void draw_puffs(Frame& frame, const std::vector<float>& depth, const Projector& projector,
                const std::vector<Puff>& puffs);

}  // namespace patrol::render
