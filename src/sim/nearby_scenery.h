#pragma once

#include <Eigen/Core>

#include <vector>

#include <mujoco/mujoco.h>

namespace patrol::sim {

/// Spares MuJoCo the search for contacts with what is out of the robot's reach. MuJoCo looks for the world's
/// geoms in a tree of boxes, for each body of the robot anew, and in a street that tree is deep: here it is
/// replaced by one of the few geoms about the robot whenever that has moved on. Actors out of reach are
/// switched off. What is left out could not have touched the robot: contacts are the same with and without.
class NearbyScenery {
 public:
  /// `physics` must outlive this; its tree and its actors' contact bits are changed.
  explicit NearbyScenery(mjModel& physics);

  /// With poses of now, or of one tick ago, in `data`.
  void update(const mjData& data);

 private:
  /// A geom of the world body and its box along the world's axes; as a node of the tree holds it.
  struct Leaf {
    int geom;
    Eigen::Vector3d centre, half;
  };
  struct Actor {
    int body;
    int contype, conaffinity;
    double radius_m;  ///< about its origin
  };

  void plant_tree(const Eigen::Vector3d& robot);
  int plant(std::vector<Leaf>::iterator begin, std::vector<Leaf>::iterator end, int depth);

  mjModel& physics_;
  int robot_;
  std::vector<Leaf> leaves_;  ///< all
  std::vector<Actor> actors_;
  std::vector<Leaf> near_;  ///< those in the tree now
  int planted_nodes_ = 0;
  Eigen::Vector3d planted_about_;
};

}  // namespace patrol::sim
