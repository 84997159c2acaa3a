#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/dust.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {

/// Fires each beam at its own instant, from where the robot is then. Every imperfection draws from its own
/// random stream, addressed by revolution and beam, so that one can be made ideal without changing the
/// others.
///
/// Where the range jumps by 0.1 to 1.5 m from one beam to the next, the light of the second is spread over
/// both surfaces and returns a range in between (a mixed pixel); over a larger jump the receiver tells the
/// two echoes apart and keeps that of the beam's axis. Not modelled: the beam's width anywhere else, multiple
/// echoes, sunlight.
class Lidar {
 public:
  /// One ring gives scans, several give clouds. `name` names the random streams; `own_housing` is what the
  /// beams start in. Dust takes from the reach and gives echoes of its own.
  Lidar(const LidarSettings& settings, const LidarScene& scene, const Pose3& T_body_lidar,
        RayMask own_housing, std::uint64_t seed, const std::string& name, const DustSettings& dust = {});

  /// Fires the beams whose instants lie in (from, to]; the body moves evenly in between.
  void advance(Time from, Time to, const Pose3& T_world_body_from, const Pose3& T_world_body_to);

  /// Revolutions completed since the last call.
  std::vector<LaserScan> take_scans() { return std::exchange(scans_, {}); }
  std::vector<PointCloud> take_clouds() { return std::exchange(clouds_, {}); }

 private:
  struct Return {
    double range_m;  ///< REP 117
    double intensity;
  };

  Time instant_of(std::int64_t beam) const;
  void fire(std::int64_t beam, const Pose3& T_world_lidar);
  Return measure(std::uint64_t tick, std::uint64_t index, const Pose3& T_world_lidar,
                 const Eigen::Vector3d& direction, double& last_range_m) const;
  Return look(const Pose3& T_world_lidar, const Eigen::Vector3d& direction) const;
  Return mix_over_width(const Pose3& T_world_lidar, const Eigen::Vector3d& direction,
                        const Return& middle) const;
  Return echo(const RayHit& hit, const Eigen::Vector3d& direction, double range_m) const;
  void begin_revolution();

  LidarSettings settings_;
  const LidarScene& scene_;
  Pose3 T_body_lidar_;
  std::uint32_t mask_;
  DustSettings dust_;
  std::vector<SurfaceOptics> surfaces_;  ///< [geom] of the view model
  double false_echoes_per_m_;  ///< of rain and dust
  RandomStream range_noise_, angle_noise_, dropout_, rain_, rain_range_;
  std::int64_t next_beam_ = 0;              ///< since the start
  std::vector<Eigen::Vector2d> azimuth_;    ///< [beam]: cosine and sine
  std::vector<Eigen::Vector2d> elevation_;  ///< [ring]: cosine and sine
  std::vector<double> last_range_m_;        ///< [ring]: without noise
  LaserScan scan_;
  PointCloud cloud_;
  std::vector<LaserScan> scans_;
  std::vector<PointCloud> clouds_;
};

}  // namespace patrol::sim
