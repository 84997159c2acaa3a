#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// Ring of transducers `ultrasonic_0`, `ultrasonic_1` ... that fire in turn.
///
/// A ping is a bundle of rays over the cone, rotated about its axis by a random angle. Echo strength per ray: 1 for a
/// smooth surface up to `specular_cutoff_deg` of incidence, 0 beyond; `rough_echo_ratio` times the cosine of incidence
/// for a rough surface. The reading is the distance at which the strength summed over one pulse length reaches
/// `detection_threshold`. This detects distant walls and a bar of 6 cm at one meter, but not the ground that a level
/// cone grazes.
///
/// Transducers that fire together may receive each other's nearest echo and report half the path length. Not modeled:
/// the robot's own shapes (a ring is mounted clear of them), double reflections, dust (far smaller than the
/// wavelength). Motion during a ping is neglected (2 cm at 1 m/s).
class UltrasonicRing {
 public:
  /// Throws InputError when the robot has no frame `ultrasonic_0`, or when slots are too short for the echo from
  /// maximum range.
  UltrasonicRing(const UltrasonicSettings& settings, const LidarScene& scene, const RobotDescription& robot,
                 std::uint64_t seed);

  /// Returns the readings of the transducers that fire in slot number `tick`.
  std::vector<UltrasonicRange> ping(const Pose3& T_world_body, Time now, std::uint64_t tick) const;

  std::size_t num_transducers() const { return T_body_transducer_.size(); }

 private:
  struct Echo {
    double distance_m;  ///< distance of the echo; +Inf if none is detected
    Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    int geom = -1;
  };

  Echo trace_ping(const Pose3& T_world_transducer, double turn_rad) const;
  double strength(int geom, double cosine) const;
  double crosstalk_range_m(const Echo& echo, const Pose3& T_world_other, const Pose3& T_world_transducer) const;
  float reading(double distance_m, std::uint64_t tick, std::uint64_t transducer) const;

  UltrasonicSettings settings_;
  const LidarScene& scene_;
  std::vector<Pose3> T_body_transducer_;
  std::vector<Eigen::Vector3d> rays_;  ///< unit vectors, in the transducer's frame
  std::vector<bool> is_rough_;         ///< roughness, [geom]
  double scale_;                       ///< scale factor of the readings due to air temperature
  RandomStream noise_, turn_, dropout_, crosstalk_;
};

}  // namespace patrol::sim
