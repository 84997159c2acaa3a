#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

#include "core/random.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

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
