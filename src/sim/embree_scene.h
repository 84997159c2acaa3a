#pragma once

#include <Eigen/Core>
#include <embree3/rtcore.h>

#include <memory>
#include <optional>
#include <vector>

#include <mujoco/mujoco.h>

#include "sim/lidar_scene.h"

namespace patrol::sim {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// A geom placed in a frame: that of the world, or that of the body which it moves with.
struct PlacedGeom {
  int geom;
  int type;
  mjtNum position[3];
  mjtNum rotation[9];
  mjtNum size[3];
};

/// Spheres, capsules, cylinders and ellipsoids.
bool is_round(int type);

/// Meshes, height fields and what else has its shape in the model, and not in the geom's size.
bool is_asset(int type);

/// Geoms that keep their places to each other, in Embree: boxes, planes, meshes and height fields as
/// triangles, and MuJoCo's own ray test for round shapes.
class EmbreeScene {
 public:
  EmbreeScene(RTCDevice device, RTCBuildQuality quality);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Throws InputError for a geom of a type that no ray can be cast at (a signed distance field, for one).
  void add(const mjModel& model, const PlacedGeom& placed);
  /// After the last geom, before the first ray.
  void build();

  /// First hit nearer than `max_range_m`; the normal is not yet turned towards the origin.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m) const;

  RTCScene handle() const { return scene_; }

 private:
  RTCGeometry make_round(const PlacedGeom& placed);
  RTCGeometry make_triangles(const mjModel& model, const PlacedGeom& placed) const;

  RTCDevice device_;
  RTCScene scene_;
  std::vector<int> geoms_;  ///< [geometry of the scene]
  std::vector<std::unique_ptr<PlacedGeom>> rounds_;
};

}  // namespace patrol::sim
