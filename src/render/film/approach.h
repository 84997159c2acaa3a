#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/ground_truth.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// How near the robot was to somebody who moves.
struct Approach {
  Time at{};
  std::string actor;  ///< the name of their body, e.g. "pedestrian_1"
  double clearance_m = 0.0;  ///< between skin and skin, true
  Eigen::Vector2d p_world_actor = Eigen::Vector2d::Zero();
};

/// Measures clearances to people and vehicles, which are the model's mocap bodies, from states of the simulation.
class ApproachFinder {
 public:
  static constexpr double kFarthest_m = 1.5;  ///< what is farther off is no approach

  /// `view` must outlive the finder.
  explicit ApproachFinder(const mjModel& view);

  /// The nearest one; none within kFarthest_m. Throws InputError when the state is not one of this model.
  std::optional<Approach> nearest(const SimState& state);

 private:
  struct Part {
    int geom;
    int actor;  ///< body; of a person's leg, the person's
  };
  const mjModel& model_;
  sim::DataPtr data_;
  std::vector<int> robot_;   ///< geoms
  std::vector<Part> actors_;
};

}  // namespace patrol::render
