#pragma once

#include <complex>

#include "sim/tem/axial_tensor.h"

namespace patrol::sim {

/// Returns the field at a unit magnetic dipole on the axis of an infinite, nonconductive cylinder in homogeneous rock,
/// without the dipole's own field, 1/m3. `frequency`: complex frequency, 1/s.
///
/// Quasi-static. In the air H is the gradient of a potential: that of the dipole [Jackson99, eq. 3.148] plus a
/// reflected part. In the rock the field is the sum of waves with H and with E along the cylinder. Both are expanded in
/// cos(k z); at the wall all three components of H are continuous, so that no current enters the air.
AxialTensor<std::complex<double>> field_in_tunnel(double rock_spm, double radius_m, std::complex<double> frequency);

/// Returns the change of the response of the rock by the air of an infinite tunnel around the coil, -dB/dt in T/s per A
/// m2, at a time after the switch-off; the axis is that of the tunnel.
///
/// To first order in the square of the ratio of radius and diffusion depth the effect is a sum over the removed rock: a
/// coil at the face has half of it. The leading term along the axis is -(5/4) mu0 sigma b^2 / t of the response of the
/// whole space; across it, it is larger by a logarithm.
AxialTensor<double> tunnel_air_response(double rock_spm, double radius_m, double time_s);

}  // namespace patrol::sim
