#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

struct RTCSceneTy;

namespace patrol::sim {

/// What a ray may hit.
enum RayMask : std::uint32_t {
  kRayScenery = 1u << 0,  ///< world and actors
  kRayRobot = 1u << 1,    ///< the robot, but for its lidars and its scanner
  kRayLidar2d = 1u << 2,  ///< the housing of the link `lidar`
  kRayLidar3d = 1u << 3,  ///< the housing of the link `lidar3d`
  kRayScanner = 1u << 4,  ///< the housing of the link `scanner`
  kRayEverything = 0x1fu,
};

struct RayHit {
  double distance_m;
  int geom;                ///< in the view model
  Eigen::Vector3d normal;  ///< unit, in world, towards the ray's origin
};

/// MuJoCo's geometry, for many rays a second. What stands still is in Embree (sim/embree_scene.h). What moves
/// has few shapes: a ray that meets the box about a moving body is taken into its frame and tried on each. So
/// nothing has to be built anew when bodies move.
///
/// Sees geom groups 0 and 2 (solid and lidar-only) and the robot's visual shapes. Agrees with mj_ray within a
/// millimetre (tests/sim/lidar_scene_test.cc).
class LidarScene {
 public:
  /// `view` must outlive the scene.
  explicit LidarScene(const mjModel& view);
  ~LidarScene();
  LidarScene(const LidarScene&) = delete;
  LidarScene& operator=(const LidarScene&) = delete;

  /// Moves the bodies to where `data` has them; of the view model or of the physics model, whose bodies are
  /// the same.
  void update(const mjData& data);

  /// First hit along the unit vector `direction`, both in world; none within `max_range_m`.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m, std::uint32_t mask) const;

  const mjModel& model() const;
  /// Embree's scene of what stands still, for those who want to measure it bare.
  RTCSceneTy* still_scene() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace patrol::sim
