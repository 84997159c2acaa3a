#pragma once

#include <complex>

#include "sim/tem/axial_tensor.h"

namespace patrol::sim {

/// Returns the secondary field of an infinite thin conductive sheet at a unit magnetic dipole in homogeneous rock,
/// 1/m3; the axis is the normal of the sheet. `conductance_s`: conductivity times thickness, S.
///
/// Sum over plane waves of the dipole [Ward88, eq. 4.46], reflected with the boundary conditions of a thin sheet:
/// tangential E is continuous, tangential H jumps by the surface current. A dipole along the normal excites TE waves
/// only; one parallel to the sheet also TM waves, whose reflection vanishes without conductive rock.
AxialTensor<std::complex<double>> sheet_field(double rock_spm, double conductance_s, double distance_m,
                                              std::complex<double> frequency);

/// Returns the response of the sheet, -dB/dt in T/s per A m2. In a nonconductive host it is that of an image dipole
/// that recedes at the speed 2 / (mu0 conductance) [Nabighian91, section 3].
AxialTensor<double> sheet_response(double rock_spm, double conductance_s, double distance_m, double time_s);

}  // namespace patrol::sim
