#pragma once

#include <vector>

#include <Eigen/Core>

/// Response model of transient-electromagnetic (TEM) soundings of rock and water, used by the simulator and by the
/// inversion. The coil is a magnetic dipole that transmits and receives at the same point. Its current, long since
/// steady, is switched off at t = 0. Rates are -dB/dt along the coil axis per unit of dipole moment, T/s per A m2.
///
/// Assumptions: homogeneous rock everywhere, without the air of the tunnel, as is usual for soundings ahead of a face.
/// A body of water or mud is a homogeneous sphere. Displacement currents are neglected; the permeability is that of the
/// vacuum.
namespace patrol {

/// Returns the rate of the rock alone, in closed form: mu0 (mu0 sigma)^(3/2) / (8 pi^(3/2)) t^(-5/2). It is the inverse
/// transform of the s^(3/2) term in the field of the dipole at its own position [Ward88, eq. 2.56 at zero distance]. A
/// coil of radius b acts as a dipole while t >> mu0 sigma b^2: 1 ns for 0.3 m in rock of 0.01 S/m.
double whole_space_response(double rock_spm, double time_s);

/// Conductive sphere in the rock, relative to the coil.
struct ConductiveSphere {
  double distance_m = 0.0;  ///< distance from the coil to the center of the sphere; greater than the radius
  double radius_m = 0.0;
  double conductivity_spm = 0.0;
};

/// Secondary rate of a sphere for a coil axis through its center (axial) and perpendicular to that direction
/// (transverse). At an angle psi between axis and direction the rate is, by symmetry, cos^2(psi) axial + sin^2(psi)
/// transverse.
struct SphereResponse {
  double axial = 0.0;
  double transverse = 0.0;
};

/// Returns the rate that a sphere adds, exactly and with the conductive host included. The dipole field is expanded in
/// spherical multipoles of both kinds, each reflected by the sphere [Wait51]; dipole in a conductive whole space after
/// [Nabighian70], [Ward88]. The inverse Laplace transform is summed along Talbot's contour [Trefethen06]. The tests
/// compare it with the Born integral in rock (1 %, the error of that integral) and with Wait's decay in a nonconductive
/// host (0.3 %). Not valid for times so early that mu0 sigma a^2 / t exceeds 10^4.
SphereResponse sphere_response(double rock_spm, const ConductiveSphere& sphere, double time_s);

/// Waveform and gates of an instrument: the current decreases in a linear ramp, and each gate averages over its width.
struct TemGateLayout {
  std::vector<double> gate_s;  ///< [gate]: geometric mean of the gate limits, after the end of the ramp
  double ramp_s = 2.6e-6;
  double gate_width = 0.15;  ///< ratio of gate width to gate center
};

/// Gate averages as weighted sums over the decay at a few nodes. Evaluating the decay is expensive, and all gates share
/// the nodes.
class TemGates {
 public:
  explicit TemGates(const TemGateLayout& window);

  /// Times after a sudden switch-off at which the decay is evaluated, s.
  const std::vector<double>& node_s() const { return node_s_; }
  /// Returns the gate averages, [gate]. `node_rate`: rates at the nodes, [node].
  Eigen::VectorXd gated(const Eigen::VectorXd& node_rate) const { return weights_ * node_rate; }

 private:
  std::vector<double> node_s_;
  Eigen::MatrixXd weights_;  ///< [gate][node]
};

/// Returns the gated rate of the rock, [gate].
Eigen::VectorXd gated_whole_space_response(const TemGates& gates, double rock_spm);
struct GatedSphereResponse {
  Eigen::VectorXd axial, transverse;  ///< gated rates of the sphere, [gate]
};
GatedSphereResponse gated_sphere_response(const TemGates& gates, double rock_spm, const ConductiveSphere& sphere);

}  // namespace patrol
