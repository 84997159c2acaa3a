#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "sim/ray_cone.h"

struct RTCSceneTy;

namespace patrol::sim {

/// Objects that a ray can hit, as bits of a mask.
enum RayMask : std::uint32_t {
  kRayScenery = 1u << 0,    ///< world and actors
  kRayRobot = 1u << 1,      ///< robot without its lidars and its scanner
  kRayLidar2d = 1u << 2,    ///< housing of the link `lidar`
  kRayLidar3d = 1u << 3,    ///< housing of the link `lidar3d`
  kRayScanner = 1u << 4,    ///< housing of the link `scanner`
  kRayLidarRear = 1u << 5,  ///< housing of the link `lidar_rear`
  kRayEverything = 0x3fu,
};

struct RayHit {
  double distance_m;
  int geom;                ///< id of the geom in the view model
  Eigen::Vector3d normal;  ///< unit normal, in world, oriented toward the ray's origin
};

/// Ray in world or in the frame of a body.
struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit vector
};

/// Ray caster on MuJoCo's geometry, for high ray rates.
///
/// Static geometry is in Embree (sim/embree_scene.h). Moving bodies have few shapes: a ray that hits the bounding box
/// of a moving body is transformed into its frame and tested against each shape. So no structure is rebuilt when bodies
/// move. A lidar casts its beams in cones: the bodies and shapes that no beam of a cone can hit are left out at once.
///
/// Includes geom groups 0 and 2 (solid and lidar-only) and the robot's visual shapes. Agrees with mj_ray to within a
/// millimeter (tests/sim/lidar_scene_test.cc).
class LidarScene {
 public:
  /// `view` must outlive the scene.
  explicit LidarScene(const mjModel& view);
  ~LidarScene();
  LidarScene(const LidarScene&) = delete;
  LidarScene& operator=(const LidarScene&) = delete;

  /// Moves the bodies to their poses in `data`, of the view model or of the physics model, which have identical bodies.
  void update(const mjData& data);

  /// Returns the first hit along the unit vector `direction`, both in world; none beyond `max_range_m`.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m,
                             std::uint32_t mask) const;

  /// Poses of the moving bodies at an instant.
  struct Poses;
  /// Returns the present poses. They do not change with later updates.
  std::shared_ptr<const Poses> poses() const;
  /// Returns the first hit with the bodies at `poses`. May be called in any thread, also during `update`.
  std::optional<RayHit> cast(const Poses& poses, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m, std::uint32_t mask) const;

  /// Moving bodies that the rays of a cone may hit before `max_range_m`.
  struct Targets {
    struct Part {
      std::size_t index;
      std::size_t begin, end;  ///< first and past-the-end index of its shapes in `shapes`
    };
    std::shared_ptr<const Poses> poses;
    RayCone cone;
    double max_range_m;
    std::uint32_t mask;
    std::vector<Part> parts = {};
    std::vector<std::size_t> shapes = {};  ///< indices in their parts
  };
  Targets targets(std::shared_ptr<const Poses> poses, const RayCone& cone, double max_range_m,
                  std::uint32_t mask) const;
  /// Returns the first hit, as `cast` at the poses of the targets does. Faster for the rays in the cone.
  std::optional<RayHit> cast(const Targets& targets, const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction) const;
  /// Returns the first hits of several rays in `hits`, which is as long as `rays`. Fastest for rays in the order of
  /// their directions.
  void cast(const Targets& targets, std::span<const Ray> rays, std::span<std::optional<RayHit>> hits) const;

  const mjModel& model() const;
  /// Returns Embree's scene of the static geometry, for benchmarks.
  RTCSceneTy* static_scene() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace patrol::sim
