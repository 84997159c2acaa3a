#pragma once

#include <Eigen/Core>

#include <vector>

/// What a transient-electromagnetic (TEM) sounding measures about rock and water: the physics that the twin plays and the robot inverts.
/// The coil is a magnetic dipole that sends and receives at one place; its current, on for long, is switched off at t = 0; rates are
/// -dB/dt along its axis per unit of its moment, T/s per A m2.
///
/// Assumed: one homogeneous rock all about, the tunnel's air left out, as is usual in soundings ahead of a face; a body of water or mud
/// is a homogeneous sphere; displacement currents are left out; everything has the permeability of the vacuum.
namespace patrol {

/// Of the rock alone, closed form: mu0 (mu0 sigma)^(3/2) / (8 pi^(3/2)) t^(-5/2), the transform of the s^(3/2) in the dipole's own field
/// (Ward and Hohmann, "Electromagnetic theory for geophysical applications", 1988, eq. 2.56 at no distance). A coil of radius b may be
/// taken for a dipole while t >> mu0 sigma b^2: for 0.3 m in rock of 0.01 S/m that is 1 ns.
double rock_rate(double rock_spm, double time_s);

/// A body in the rock, seen from the coil.
struct ConductiveSphere {
  double distance_m = 0.0;  ///< from the coil to its middle, more than its radius
  double radius_m = 0.0;
  double conductivity_spm = 0.0;
};

/// What a sphere adds, for a coil that points at its middle and for one across: at an angle psi between, by symmetry,
/// cos^2(psi) axial + sin^2(psi) transverse.
struct SphereRate {
  double axial = 0.0;
  double transverse = 0.0;
};

/// Exact, host included: the dipole's field in spherical multipoles of both kinds, each reflected by the sphere (Wait, "A conducting sphere in a
/// time varying magnetic field", Geophysics 16, 1951; for a dipole in a conductive whole space Nabighian, "Quasi-static transient response
/// of a conducting permeable sphere in a dipolar field", Geophysics 35, 1970, and Ward and Hohmann, 1988), back to time along Talbot's
/// contour (Trefethen, Weideman and Schmelzer, "Talbot quadratures and rational approximations", BIT 46, 2006).
/// The tests hold it to the Born integral in rock (1 %, its own error) and to Wait's decay in the void (0.3 %). Not for times so early that
/// mu0 sigma a^2 / t passes 10^4.
SphereRate sphere_rate(double rock_spm, const ConductiveSphere& sphere, double time_s);

/// How an instrument sees a decay: the current falls in a straight ramp and not at once, and each gate takes the mean over its width.
struct TemWindow {
  std::vector<double> gate_s;  ///< [gate]: geometric middle, after the end of the ramp
  double ramp_s = 2.6e-6;
  double gate_width = 0.15;    ///< of a gate, over its middle
};

/// The gates as sums over the decay at a few instants: a decay is dear, and one serves all gates.
class TemGates {
 public:
  explicit TemGates(const TemWindow& window);

  /// The instants at which a decay after a sudden switch-off is asked for, s.
  const std::vector<double>& node_s() const { return node_s_; }
  /// `node_rate`: [node]. Returns [gate].
  Eigen::VectorXd gated(const Eigen::VectorXd& node_rate) const { return weights_ * node_rate; }

 private:
  std::vector<double> node_s_;
  Eigen::MatrixXd weights_;  ///< [gate][node]
};

/// The same of rock and sphere, [gate].
Eigen::VectorXd gated_rock(const TemGates& gates, double rock_spm);
struct GatedSphere {
  Eigen::VectorXd axial, transverse;  ///< [gate]
};
GatedSphere gated_sphere(const TemGates& gates, double rock_spm, const ConductiveSphere& sphere);

}  // namespace patrol
