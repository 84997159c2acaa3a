#pragma once

#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/sensors/tem_response.h"
#include "inspect/water/water_sounding.h"

namespace patrol::test {

/// The tracked robot's mount.
inline AntennaGeometry antenna_mount() {
  AntennaGeometry antenna;
  antenna.T_body_mount = {{0.13, 0.0, 0.83}, Eigen::Quaterniond::Identity()};
  antenna.yaw = {.lower_rad = -1.2, .upper_rad = 1.2, .velocity_radps = 6.6, .effort_nm = 6.0};
  antenna.pitch = {.lower_rad = -1.62, .upper_rad = 0.7, .velocity_radps = 6.6, .effort_nm = 6.0};
  return antenna;
}

/// Soundings of rock and, if it has a radius, a body in the direction `towards` from the coil, with independent normal
/// errors of 1 % and 3 nT/s at 1 ms.
inline std::vector<inspect::OrientedSounding> make_soundings(double rock_spm, const ConductiveSphere& body,
                                                             const Eigen::Vector3d& towards,
                                                             const std::vector<inspect::AntennaPose>& poses,
                                                             std::uint64_t seed) {
  TemGateLayout window;
  for (double gate_s = 2e-6; gate_s <= 3e-4; gate_s *= std::pow(10.0, 0.1)) window.gate_s.push_back(gate_s);
  const TemGates gates(window);
  const Eigen::VectorXd rock = gated_whole_space_response(gates, rock_spm);
  GatedSphereResponse sphere{.axial = Eigen::VectorXd::Zero(rock.size()),
                             .transverse = Eigen::VectorXd::Zero(rock.size())};
  if (body.radius_m > 0.0) sphere = gated_sphere_response(gates, rock_spm, body);
  const RandomStream noise(seed, "test/soundings");
  std::vector<inspect::OrientedSounding> soundings;
  for (const inspect::AntennaPose& pose : poses) {
    const Eigen::Vector3d axis = quaternion_from_rpy(0.0, pose.pitch_rad, pose.yaw_rad) * Eigen::Vector3d::UnitX();
    const double cosine = axis.dot(towards);
    TemSounding sounding{.stamp = from_seconds(static_cast<double>(soundings.size() + 1)),
                         .moment_am2 = 34.0,
                         .gate_s = window.gate_s,
                         .rate_tps = {},
                         .std_tps = {}};
    for (Eigen::Index gate = 0; gate < rock.size(); ++gate) {
      const double rate_tps = 34.0 * (rock[gate] + sphere.transverse[gate] +
                                      cosine * cosine * (sphere.axial[gate] - sphere.transverse[gate]));
      const double std_tps =
          std::hypot(0.01 * rate_tps, 3e-9 * std::sqrt(1e-3 / window.gate_s[static_cast<std::size_t>(gate)]));
      sounding.rate_tps.push_back(rate_tps +
                                  std_tps * noise.normal(soundings.size(), static_cast<std::uint64_t>(gate)));
      sounding.std_tps.push_back(std_tps);
    }
    soundings.push_back({pose, sounding});
  }
  return soundings;
}

}  // namespace patrol::test
