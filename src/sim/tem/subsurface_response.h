#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/sensors/tem_response.h"
#include "sim/subsurface.h"
#include "sim/tem/axial_tensor.h"
#include "sim/tem/spheroid.h"

namespace patrol::sim {

/// Returns the subsurface of one seed: conductivities sampled around their medians. Throws InputError for
/// invalid settings of the rock.
Subsurface sample_subsurface(Subsurface subsurface, std::uint64_t seed);

/// Response of rock, tunnel air, fault zone and water bodies to a coil.
///
/// The responses are summed. Neglected: the mutual screening of bodies and fault zone, which is of the order of the
/// product of their relative responses, and the effect of the tunnel on the field at the bodies.
class SubsurfaceResponse {
 public:
  /// Precomputes what does not depend on the coil: 0.3 s per spheroid.
  SubsurfaceResponse(Subsurface subsurface, const TemGates& gates);

  /// Returns the gated rates -dB/dt per unit of moment, [gate], of a coil whose axis a has the mean outer product
  /// `axes` = <a a^T>. Throws InputError if a body contains the coil.
  Eigen::VectorXd gated_rate(const Eigen::Vector3d& p_world_m, const Eigen::Matrix3d& axes) const;

 private:
  Eigen::VectorXd body_rate(std::size_t body, const Eigen::Vector3d& p_world_m, const Eigen::Matrix3d& axes) const;
  Eigen::VectorXd fault_zone_rate(const Eigen::Vector3d& p_world_m, const Eigen::Matrix3d& axes) const;
  Eigen::VectorXd air_rate(const Eigen::Matrix3d& axes) const;

  Subsurface subsurface_;
  TemGates gates_;
  std::vector<AxialTensor<double>> air_;                   ///< [time node]; empty without air
  std::vector<std::vector<SpheroidScattering>> spheroid_;  ///< [body][time node, frequency]; empty for spheres
};

}  // namespace patrol::sim
