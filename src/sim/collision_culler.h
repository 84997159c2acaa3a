#pragma once

#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace patrol::sim {

/// Broad-phase culling of contacts for MuJoCo.
///
/// MuJoCo searches a static bounding-volume tree of the world's geoms for each body of the robot; in a street that tree
/// is deep. This class replaces it by a tree of the few geoms near the robot and rebuilds it when the robot has moved.
/// It disables contacts of distant actors. Contacts are identical with and without culling.
class CollisionCuller {
 public:
  /// `physics` must outlive this; its tree and the contact bits of its actors are changed.
  explicit CollisionCuller(mjModel& physics);

  /// Updates the culling with the poses in `data`, which may be one tick old.
  void update(const mjData& data);

  /// Saves or restores the center of the tree, and rebuilds the tree. The contact bits are part of the model.
  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(bvh_center_);
    if (archive.is_loading() && bvh_center_.allFinite()) rebuild_bvh(bvh_center_);
  }

 private:
  /// Geom of the world body and its axis-aligned bounding box, as stored in a tree node.
  struct Leaf {
    int geom;
    Eigen::Vector3d center, half;
  };
  struct Actor {
    int body;
    int contype, conaffinity;
    double radius_m;  ///< radius around the body's origin
  };

  void rebuild_bvh(const Eigen::Vector3d& robot);
  int build_bvh(std::vector<Leaf>::iterator begin, std::vector<Leaf>::iterator end, int depth);

  mjModel& physics_;
  int robot_;
  double robot_extent_m_;
  std::vector<Leaf> leaves_;  ///< all geoms of the world body
  std::vector<Actor> actors_;
  std::vector<Leaf> near_leaves_;  ///< geoms in the present tree
  int num_nodes_ = 0;
  Eigen::Vector3d bvh_center_;
};

}  // namespace patrol::sim
