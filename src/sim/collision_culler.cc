#include "sim/collision_culler.h"

#include <algorithm>
#include <limits>

#include "core/frames.h"

namespace patrol::sim {
namespace {

constexpr double kMinRobotExtent_m = 0.8;   // extent of a robot from its origin, if its parts reach less
constexpr double kRebuildDistance_m = 0.2;  // travel after which the tree is rebuilt
constexpr double kMotionMargin_m = 0.05;    // exceeds the motion of any body in one tick

/// Returns the largest distance of a part of the robot from its origin in any posture.
double robot_extent_m(const mjModel& physics, int robot) {
  std::vector<double> reach_m(static_cast<std::size_t>(physics.nbody), 0.0);  // of the origin of each body
  double extent_m = kMinRobotExtent_m;
  for (int body = std::max(robot, 1); body < physics.nbody; ++body) {
    if (physics.body_rootid[body] != robot) continue;
    const auto index = static_cast<std::size_t>(body);
    if (body != robot) {
      reach_m[index] = reach_m[static_cast<std::size_t>(physics.body_parentid[body])] +
                       Eigen::Vector3d(physics.body_pos + 3 * body).norm();
    }
    for (int i = 0; i < physics.body_geomnum[body]; ++i) {
      const int geom = physics.body_geomadr[body] + i;
      extent_m = std::max(extent_m, reach_m[index] + Eigen::Vector3d(physics.geom_pos + 3 * geom).norm() +
                                        physics.geom_rbound[geom]);
    }
  }
  return extent_m;
}

}  // namespace

CollisionCuller::CollisionCuller(mjModel& physics)
    : physics_(physics),
      robot_(mj_name2id(&physics, mjOBJ_BODY, frame_id::kBody)),
      robot_extent_m_(robot_extent_m(physics, robot_)),
      bvh_center_(Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())) {
  const int root = physics.body_bvhadr[0];
  for (int node = root; node < root + physics.body_bvhnum[0]; ++node) {
    if (physics.bvh_nodeid[node] < 0) continue;
    const mjtNum* box = physics.bvh_aabb + 6 * node;
    leaves_.push_back({physics.bvh_nodeid[node], Eigen::Vector3d(box), Eigen::Vector3d(box + 3)});
  }
  std::sort(leaves_.begin(), leaves_.end(), [](const Leaf& a, const Leaf& b) { return a.geom < b.geom; });
  for (int body = 1; body < physics.nbody; ++body) {
    if (physics.body_mocapid[body] < 0) continue;
    Actor actor{.body = body,
                .contype = physics.body_contype[body],
                .conaffinity = physics.body_conaffinity[body],
                .radius_m = 0.0};
    for (int i = 0; i < physics.body_geomnum[body]; ++i) {
      const int geom = physics.body_geomadr[body] + i;
      actor.radius_m =
          std::max(actor.radius_m, Eigen::Vector3d(physics.geom_pos + 3 * geom).norm() + physics.geom_rbound[geom]);
    }
    actors_.push_back(actor);
  }
}

void CollisionCuller::update(const mjData& data) {
  const Eigen::Vector3d robot(data.xpos + 3 * robot_);
  if (!leaves_.empty() && !((robot - bvh_center_).cwiseAbs().maxCoeff() < kRebuildDistance_m)) rebuild_bvh(robot);
  for (const Actor& actor : actors_) {
    const double reach = actor.radius_m + robot_extent_m_ + kMotionMargin_m;
    const bool is_near = (Eigen::Vector3d(data.xpos + 3 * actor.body) - robot).squaredNorm() < reach * reach;
    physics_.body_contype[actor.body] = is_near ? actor.contype : 0;
    physics_.body_conaffinity[actor.body] = is_near ? actor.conaffinity : 0;
  }
}

void CollisionCuller::rebuild_bvh(const Eigen::Vector3d& robot) {
  bvh_center_ = robot;
  near_leaves_.clear();
  const Eigen::Array3d reach = Eigen::Array3d::Constant(robot_extent_m_ + kRebuildDistance_m + kMotionMargin_m);
  for (const Leaf& leaf : leaves_) {
    if (((leaf.center - robot).array().abs() < leaf.half.array() + reach).all()) near_leaves_.push_back(leaf);
  }
  if (near_leaves_.empty()) near_leaves_.push_back(leaves_.front());  // a tree has at least one leaf
  num_nodes_ = 0;
  build_bvh(near_leaves_.begin(), near_leaves_.end(), 0);
  physics_.body_bvhnum[0] = num_nodes_;
}

/// Appends the tree over [begin, end) to the nodes written so far, parents first as in MuJoCo; returns its root.
int CollisionCuller::build_bvh(std::vector<Leaf>::iterator begin, std::vector<Leaf>::iterator end, int depth) {
  const int node = num_nodes_++;
  Eigen::Vector3d lower = begin->center - begin->half, upper = begin->center + begin->half;
  for (auto leaf = begin + 1; leaf != end; ++leaf) {
    lower = lower.cwiseMin(leaf->center - leaf->half);
    upper = upper.cwiseMax(leaf->center + leaf->half);
  }
  int left = -1, right = -1;
  if (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    int axis = 0;
    (upper - lower).maxCoeff(&axis);
    std::sort(begin, end, [axis](const Leaf& a, const Leaf& b) {
      return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis] : a.geom < b.geom;
    });
    left = build_bvh(begin, middle, depth + 1);
    right = build_bvh(middle, end, depth + 1);
  }
  const int address = physics_.body_bvhadr[0] + node;
  physics_.bvh_depth[address] = depth;
  physics_.bvh_child[2 * address] = left;
  physics_.bvh_child[2 * address + 1] = right;
  physics_.bvh_nodeid[address] = left < 0 ? begin->geom : -1;
  const Eigen::Vector3d center = (lower + upper) / 2.0, half = (upper - lower) / 2.0;
  std::copy_n(center.data(), 3, physics_.bvh_aabb + 6 * address);
  std::copy_n(half.data(), 3, physics_.bvh_aabb + 6 * address + 3);
  return node;
}

}  // namespace patrol::sim
