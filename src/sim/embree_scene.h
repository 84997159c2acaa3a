#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <embree3/rtcore.h>
#include <mujoco/mujoco.h>

#include "sim/lidar_scene.h"

namespace patrol::sim {

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Geom with its pose in a frame: world, or the body that it is attached to.
struct PlacedGeom {
  int geom;
  int type;
  mjtNum position[3];
  mjtNum rotation[9];
  mjtNum size[3];
};

/// Returns whether the type is a sphere, capsule, cylinder or ellipsoid.
bool is_analytic(int type);

/// Returns whether the shape is stored in the model instead of in the geom's size: meshes, height fields and others.
bool is_asset(int type);

/// Rigid set of geoms in Embree: boxes, planes, meshes and height fields as triangles; MuJoCo's own ray test for round
/// shapes.
class EmbreeScene {
 public:
  EmbreeScene(RTCDevice device, RTCBuildQuality quality);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Throws InputError for a geom type that no ray can be cast at, e.g. a signed distance field.
  void add(const mjModel& model, const PlacedGeom& placed);
  /// Builds the scene. Call after the last `add` and before the first `cast`.
  void build();

  /// Returns the first hit within `max_range_m`. Its normal is not yet oriented toward the origin.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m) const;
  /// Returns the same for several rays in `hits`, which is as long as `rays`. Rays with neighboring directions are
  /// traced together.
  void cast(std::span<const Ray> rays, double max_range_m, std::span<std::optional<RayHit>> hits) const;

  RTCScene handle() const { return scene_; }

 private:
  RTCGeometry make_round(const PlacedGeom& placed);
  RTCGeometry make_triangles(const mjModel& model, const PlacedGeom& placed) const;

  RTCDevice device_;
  RTCScene scene_;
  std::vector<int> geoms_;  ///< geom ids, [geometry of the scene]
  std::vector<std::unique_ptr<PlacedGeom>> rounds_;
};

}  // namespace patrol::sim
