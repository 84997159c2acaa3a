#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/random.h"
#include "core/robot_description.h"
#include "core/settings.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// A ring of ultrasonic transducers, each of the class of MaxBotix's XL-MaxSonar-EZ (data sheet PD11840: 42 kHz, from 0.2 m,
/// steps of 1 cm, nearer things reported as too near, accuracy by the temperature of the air). Where sound comes back from
/// follows Leonard, Durrant-Whyte, "Directed sonar sensing for mobile robot navigation", 1992: at a wavelength of 8 mm walls
/// are mirrors. The two figures of the echo's strength are assumptions.
struct UltrasonicSettings {
  bool enabled = false;
  double ping_rate_hz = 40.0;      ///< slots of the ring; in each, one transducer or one group of them fires
  int fire_together = 1;           ///< transducers of a group, spread round the ring: a faster round, and cross-talk
  double fov_deg = 35.0;           ///< full angle of the cone
  double range_min_m = 0.2;
  double range_max_m = 4.0;
  double range_noise_m = 0.005;    ///< standard deviation
  double range_resolution_m = 0.01;
  double smooth_deg = 25.0;        ///< a smooth surface met flatter than this from its normal throws the sound elsewhere
  double rough_echo = 0.37;        ///< echo of a rough surface, of that of a smooth one, both met squarely
  double least_echo = 0.02;        ///< least echo that is heard, of that of a smooth wall before the whole cone
  double dropout = 0.02;           ///< share of pings that hear nothing for no reason
  double crosstalk = 0.5;          ///< chance that another's echo is taken for one's own, where it can be heard
  double air_temperature_c = 15.0;
  double assumed_temperature_c = 20.0;  ///< for which the speed of sound is set
  /// Words in the names of rough geoms or of their materials; height fields are rough.
  std::vector<std::string> rough_names = {"rock", "rubble", "gravel", "soil", "shotcrete", "muck"};
  double latency_s = 0.03;         ///< until the farthest echo could have come

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("ping_rate_hz", self.ping_rate_hz, between(0.1, 200.0));
    visit("fire_together", self.fire_together, between(1, 64));
    visit("fov_deg", self.fov_deg, between(1.0, 150.0));
    visit("range_min_m", self.range_min_m, at_least(0.0));
    visit("range_max_m", self.range_max_m, between(0.1, 20.0));
    visit("range_noise_m", self.range_noise_m, at_least(0.0));
    visit("range_resolution_m", self.range_resolution_m, at_least(0.0));
    visit("smooth_deg", self.smooth_deg, between(0.0, 90.0));
    visit("rough_echo", self.rough_echo, between(0.0, 1.0));
    visit("least_echo", self.least_echo, between(0.0, 1.0));
    visit("dropout", self.dropout, between(0.0, 1.0));
    visit("crosstalk", self.crosstalk, between(0.0, 1.0));
    visit("air_temperature_c", self.air_temperature_c, between(-40.0, 85.0));
    visit("assumed_temperature_c", self.assumed_temperature_c, between(-40.0, 85.0));
    visit("rough_names", self.rough_names);
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

/// The transducers `ultrasonic_0`, `ultrasonic_1` ... fire in turn. A ping is a bundle of rays over the cone, turned by chance
/// about its axis. Each brings back a share of the sound: all from a smooth surface that it meets nearly squarely, nothing from
/// one that it meets flatter, the cosine of the angle from a rough one. The reading is where as much as can be heard has come
/// back within the length of a pulse: walls far off, a bar of 6 cm at a metre, not the ground that a level cone grazes.
///
/// Where several fire together, each may hear the nearest echo of another, half the way from that one to itself.
/// Not modelled: the robot's own shapes (a ring is mounted to be free of them), echoes by way of two surfaces, dust (it is
/// far smaller than the wave), the robot's way during a ping (2 cm at 1 m/s).
class UltrasonicRing {
 public:
  /// Throws InputError when the robot has no frame `ultrasonic_0`, or when slots are too short for the farthest echo.
  UltrasonicRing(const UltrasonicSettings& settings, const LidarScene& scene, const RobotDescription& robot, std::uint64_t seed);

  /// Slot number `tick`: the readings of the transducers that fire in it.
  std::vector<UltrasonicRange> ping(const Pose3& T_world_body, Time now, std::uint64_t tick) const;

  std::size_t num_transducers() const { return T_body_transducer_.size(); }

 private:
  struct Echo {
    double distance_m;  ///< +Inf if none is heard
    Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    int geom = -1;
  };

  Echo listen(const Pose3& T_world_transducer, double turn_rad) const;
  double strength(int geom, double cosine) const;
  double heard_of_other_m(const Echo& echo, const Pose3& T_world_other, const Pose3& T_world_transducer) const;
  float reading(double distance_m, std::uint64_t tick, std::uint64_t transducer) const;

  UltrasonicSettings settings_;
  const LidarScene& scene_;
  std::vector<Pose3> T_body_transducer_;
  std::vector<Eigen::Vector3d> rays_;  ///< unit, in the transducer's frame
  std::vector<bool> is_rough_;         ///< [geom]
  double scale_;                       ///< of readings, by the air's temperature
  RandomStream noise_, turn_, dropout_, crosstalk_;
};

}  // namespace patrol::sim
