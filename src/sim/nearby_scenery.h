#pragma once

#include <Eigen/Core>

#include <vector>

#include <mujoco/mujoco.h>

namespace patrol::sim {

/// Moves the world's geoms out of the world body into still bodies, one for each cell of a grid, behind all other bodies.
/// Nothing moves or collides differently; but then cells can be left out of the search for contacts (NearbyScenery).
void gather_scenery_in_cells(mjSpec& world);

/// Spares MuJoCo the search for contacts with what is out of the robot's reach: still bodies and actors. A body that is
/// switched off could not have touched the robot, so contacts are the same with and without.
class NearbyScenery {
 public:
  /// `physics` must outlive this; it is switched through its bodies' contype and conaffinity.
  explicit NearbyScenery(mjModel& physics);

  /// With poses of now, or of one tick ago, in `data`.
  void update(const mjData& data);

 private:
  struct Body {
    int body;
    int contype, conaffinity;
    Eigen::Vector2d lower, upper;  ///< of a box about it: in world where it stands still, about its origin where it moves
    bool is_moving;
  };

  mjModel& physics_;
  int robot_;
  std::vector<Body> bodies_;
};

}  // namespace patrol::sim
