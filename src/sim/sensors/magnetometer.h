#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "core/random.h"
#include "core/sensors/registry.h"

namespace patrol::sim {

/// Magnetometer among steel.
///
/// A steel geom outside the robot is modeled as a sphere of high permeability in the center of the geom's bounding box.
/// Its volume is `steel_fill` of that box. The geomagnetic field induces a dipole in it [Jackson99, section 5.11]. The
/// robot's own steel is the hard and soft iron: reading = soft_iron * field + hard_iron, in the sensor's frame, both
/// constant over a run. Not modeled: permanent magnetization of steel outside the robot, dipoles that induce each
/// other, currents of motors and cables.
class Magnetometer {
 public:
  /// `view` must outlive the magnetometer.
  Magnetometer(const MagnetometerSettings& settings, const mjModel& view, std::uint64_t seed);

  /// Returns the field in world, T. Body poses are taken from `data`, of the view model or of the physics model.
  Eigen::Vector3d field_t(const mjData& data, const Eigen::Vector3d& p_world) const;

  /// Takes reading number `index`.
  MagneticField read(const mjData& data, const Pose3& T_world_sensor, Time now, std::uint64_t index) const;

  /// Returns the reading for a given field in the sensor's frame.
  MagneticField measure(const Eigen::Vector3d& field_t, Time now, std::uint64_t index) const;

  const Eigen::Vector3d& hard_iron_t() const { return hard_iron_t_; }

 private:
  struct SteelSphere {
    int body;
    Eigen::Vector3d p_body;  ///< center, m
    double radius_m;
  };

  MagnetometerSettings settings_;
  Eigen::Vector3d geomagnetic_t_;  ///< in world
  std::vector<SteelSphere> steel_;
  Eigen::Matrix3d soft_iron_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d hard_iron_t_ = Eigen::Vector3d::Zero();
  RandomStream noise_;
};

}  // namespace patrol::sim
