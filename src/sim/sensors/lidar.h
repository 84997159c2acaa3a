#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "sim/dust.h"
#include "sim/lidar_scene.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {

/// A spinning lidar, of one ring or several. Defaults are those of the preset.
struct LidarSettings {
  std::string preset = "rplidar_s2";
  bool enabled = true;
  double rate_hz = 10.0;  ///< revolutions
  int beams = 3200;       ///< firings per revolution (over the field of view)
  int rings = 1;
  double fov_deg = 360.0;          ///< horizontal, symmetric about the front
  double elevation_min_deg = 0.0;  ///< of the lowest ring
  double elevation_max_deg = 0.0;  ///< of the highest ring
  double range_min_m = 0.05;
  double range_max_m = 30.0;
  double range_noise_m = 0.015;       ///< standard deviation
  double range_resolution_m = 0.013;  ///< quantisation
  double angle_noise_deg = 0.01;      ///< standard deviation of a beam's direction
  double beam_width_deg =
      0.12;                    ///< over it a beam's light is spread (across the ring): mixed pixels at edges
  double dropout = 0.002;      ///< share of beams that are lost for no reason
  double grazing_deg = 85.0;   ///< beams that meet a surface flatter than this are lost
  double dark_range_m = 10.0;  ///< range on a surface of 10 % reflectivity
  double rain_rate = 0.0;      ///< chance per metre that a drop or a grain of dust reflects the beam
  double latency_s = 0.005;    ///< from the last beam to the message
  bool motion_distortion = true;  ///< false: the whole revolution is seen from where it ends
  bool stabilized = false;        ///< true: held level whatever the body does, by an ideal gimbal; the stack must know (leveling.stabilized)

  /// From public data sheets: "rplidar_s2" (Slamtec RPLIDAR S2: 10 Hz, 32,000 samples/s, 0.05-30 m, 10 m on
  /// 10 %,
  /// +-30 mm, 13 mm steps), "utm30lx" (Hokuyo UTM-30LX: 40 Hz, 0.25 deg over 270 deg, 0.1-30 m, +-30 mm, 1 mm
  /// steps), "tim571" (SICK TiM571: 15 Hz, 0.33 deg over 270 deg, 0.05-25 m, 8 m on 10 %, 20 mm), "vlp16"
  /// (Velodyne VLP-16: 10 Hz, 16 rings over +-15 deg, 1,800 firings, 100 m, +-30 mm, 2 mm steps, 3 mrad
  /// wide). A stated "+-" is read as two standard deviations. The widths of the others' beams are not in
  /// their sheets: about the angle from beam to beam is assumed.
  static LidarSettings of_preset(const std::string& name);

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("preset", self.preset, one_of({"rplidar_s2", "utm30lx", "tim571", "vlp16"}));
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.5, 100.0));
    visit("beams", self.beams, between(4, 100000));
    visit("rings", self.rings, between(1, 128));
    visit("fov_deg", self.fov_deg, between(1.0, 360.0));
    visit("elevation_min_deg", self.elevation_min_deg, between(-90.0, 90.0));
    visit("elevation_max_deg", self.elevation_max_deg, between(-90.0, 90.0));
    visit("range_min_m", self.range_min_m, at_least(0.0));
    visit("range_max_m", self.range_max_m, between(0.1, 400.0));
    visit("range_noise_m", self.range_noise_m, at_least(0.0));
    visit("range_resolution_m", self.range_resolution_m, at_least(0.0));
    visit("angle_noise_deg", self.angle_noise_deg, between(0.0, 10.0));
    visit("beam_width_deg", self.beam_width_deg, between(0.0, 5.0));
    visit("dropout", self.dropout, between(0.0, 1.0));
    visit("grazing_deg", self.grazing_deg, between(0.0, 90.0));
    visit("dark_range_m", self.dark_range_m, at_least(0.0));
    visit("rain_rate", self.rain_rate, between(0.0, 1.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
    visit("motion_distortion", self.motion_distortion);
    visit("stabilized", self.stabilized);
  }
};

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
