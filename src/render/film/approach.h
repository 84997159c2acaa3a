#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/ground_truth.h"
#include "sim/mujoco.h"

namespace patrol::render {

/// Closest moving actor near the robot at one time.
struct Approach {
  Time at{};
  std::string actor;         ///< name of the actor's body, e.g. "pedestrian_1"; "body 7" without one
  double clearance_m = 0.0;  ///< true distance between the surfaces of robot and actor
  Eigen::Vector2d p_world_actor = Eigen::Vector2d::Zero();
};

/// Measures the clearance between the robot and pedestrians or vehicles (the model's mocap bodies) from states of the
/// simulation.
class ApproachFinder {
 public:
  static constexpr double kMaxRange_m = 1.5;  ///< actors farther away are ignored

  /// `view` must outlive this object.
  explicit ApproachFinder(const mjModel& view);

  /// Returns the nearest actor, none within kMaxRange_m. Throws InputError when the state does not belong to this
  /// model.
  std::optional<Approach> nearest(const SimState& state);

 private:
  struct Part {
    int geom;
    int actor;  ///< body id; for a limb, the pedestrian's main body
  };
  const mjModel& model_;
  sim::DataPtr data_;
  std::vector<int> robot_;  ///< geom ids
  std::vector<Part> actors_;
};

}  // namespace patrol::render
