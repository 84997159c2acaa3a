#pragma once

#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "render/camera.h"
#include "render/frame.h"
#include "sim/gas_plume.h"

namespace patrol::render {

/// A soft ball of gas.
struct Puff {
  Eigen::Vector3d p_world_m;
  double radius_m;    ///< standard deviation of its density
  double column_ppm_m;  ///< of methane, through its middle
};

/// A run's leaks, for the eye: puffs that drift downwind, as dense as the twin's own plume is where they are. The plume is a
/// steady one: how they drift says nothing but where the wind blows to.
class GasCloud {
 public:
  GasCloud() = default;
  /// Throws InputError when a leak names a site that the world does not have.
  GasCloud(const mjModel& world, const std::vector<sim::LeakSettings>& leaks, const sim::WindSettings& wind);

  bool is_empty() const { return plumes_.empty(); }
  /// `now_s` of the run: a leak may begin later. `drift_m`: how far the puffs have come.
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

/// Draws them on a finished frame, hidden by what stands before them; `depth` as in Offscreen::read_depth. A column of
/// kVeiling_ppm_m lets 37 % of what is behind through.
inline constexpr double kVeiling_ppm_m = 4000.0;
void draw_puffs(Frame& frame, const std::vector<float>& depth, const Projector& projector, const std::vector<Puff>& puffs);

}  // namespace patrol::render
