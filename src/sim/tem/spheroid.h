#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

namespace patrol::sim {

/// Homogeneous conductive spheroid.
struct ConductiveSpheroid {
  double polar_m = 0.0;       ///< semi-axis along the axis of symmetry
  double equatorial_m = 0.0;  ///< semi-axis across it
  double conductivity_spm = 0.0;
};

/// Scattering of the quasi-static field of magnetic dipoles by a conductive spheroid in conductive rock, at one complex
/// frequency.
///
/// Extended boundary condition (T-matrix) method of [Waterman71], as in [Mishchenko02, section 5.8], with the modified
/// spherical Bessel functions of a diffusive medium. The field outside the spheroid is expanded in vector spherical
/// functions: regular R_v (incident) and decaying O_v (scattered). With the antisymmetric surface product
///   <A, B> = integral of [A x curl B - B x curl A] n dS,
/// which is the same on all surfaces between which both fields satisfy the equation of the rock, and R'_v the regular
/// functions inside, T = -S P Q^-1 S, with P = <R, R'>, Q = <O, R'> and S = +-1 from the normalization. The surface
/// integrals are sums of 48 points. The interior and its host are included exactly, up to the order of the expansion.
///
/// Valid for dipoles farther from the center than the longer semi-axis, and for ratios of the semi-axes between 1/3 and
/// 3.
class SpheroidScattering {
 public:
  SpheroidScattering(double rock_spm, const ConductiveSpheroid& spheroid, std::complex<double> frequency, int order);

  /// Returns the tensor G of the secondary field H = G u at the position of a dipole of unit moment along u, 1/m3.
  /// `p`: position relative to the center, in a frame whose z axis is the axis of symmetry, m. G is symmetric by
  /// reciprocity.
  Eigen::Matrix3cd field_at_dipole(const Eigen::Vector3d& p_m) const;

 private:
  std::complex<double> gamma_;  ///< propagation constant of the rock, 1/m
  int order_;
  std::vector<Eigen::MatrixXcd> T_;  ///< [azimuthal order]; rows, columns: TE of each degree, then TM
};

}  // namespace patrol::sim
