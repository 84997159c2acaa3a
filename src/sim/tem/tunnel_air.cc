#include "sim/tem/tunnel_air.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/sensors/tem_response.h"
#include "sim/tem/laplace_inversion.h"
#include "sim/tem/permeability.h"

namespace patrol::sim {
namespace {

using Complex = std::complex<double>;

/// Returns K_1(z) / K_0(z) for a positive real part of z, by the trapezoidal rule on K_n(z) = integral of e^(-z cosh t)
/// cosh(n t) over t > 0 [DLMF10, eq. 10.32.9].
Complex bessel_k_ratio(Complex z) {
  constexpr double kStep = 0.08, kNegligible = 40.0;
  Complex k0 = 0.5, k1 = 0.5;
  for (int i = 1;; ++i) {
    const double t = kStep * i, rise = 2.0 * std::pow(std::sinh(0.5 * t), 2);  // cosh t - 1
    if (z.real() * rise > kNegligible) return k1 / k0;
    const Complex value = std::exp(-z * rise);
    k0 += value;
    k1 += (1.0 + rise) * value;
  }
}

/// Amplitudes of the reflected potentials I_0(k rho) cos(k z) and I_1(k rho) cos(phi) cos(k z) at the wave number k,
/// times k.
AxialTensor<Complex> reflection(double k, double radius_m, Complex gamma) {
  const double x = k * radius_m;
  const double k0 = std::cyl_bessel_k(0.0, x), k1 = std::cyl_bessel_k(1.0, x), i0 = std::cyl_bessel_i(0.0, x),
               i1 = std::cyl_bessel_i(1.0, x);
  const double k1_slope = -k0 - k1 / x, i1_slope = i0 - i1 / x;
  const Complex u = std::sqrt(k * k + gamma * gamma), ratio = bessel_k_ratio(u * radius_m);
  const Complex along = k / u * ratio;
  const Complex p = -u / ratio - 1.0 / radius_m;  // u K_1'(u b) / K_1(u b)
  const Complex g = (gamma * gamma / (radius_m * radius_m * p) + k * k * p) / (u * u);
  return {.along = k * k * (along * k0 - k1) / (i1 + along * i0),
          .across = 0.5 * k * k * (k * k1_slope - g * k1) / (k * i1_slope - g * i1)};
}

}  // namespace

AxialTensor<Complex> field_in_tunnel(double rock_spm, double radius_m, Complex frequency) {
  const Complex gamma = std::sqrt(kPermeability * rock_spm * frequency);
  // Trapezoidal rule in ln k: the integrand falls as k^2 below and as e^(-2 k b) above.
  constexpr double kStep = 0.08, kLargest = 25.0;
  const double smallest = 1e-5 * std::min(1.0, std::abs(gamma) * radius_m);
  AxialTensor<Complex> field;
  for (double x = kLargest; x > smallest; x *= std::exp(-kStep)) {
    const double k = x / radius_m;
    const AxialTensor<Complex> value = reflection(k, radius_m, gamma);
    field.along += kStep * k * value.along;
    field.across += kStep * k * value.across;
  }
  field.along /= 2.0 * std::numbers::pi * std::numbers::pi;
  field.across /= 2.0 * std::numbers::pi * std::numbers::pi;
  return field;
}

AxialTensor<double> tunnel_air_response(double rock_spm, double radius_m, double time_s) {
  if (radius_m <= 0.0) return {};
  AxialTensor<double> rate;
  for (const LaplaceNode& node : laplace_nodes()) {
    const AxialTensor<Complex> field = field_in_tunnel(rock_spm, radius_m, node.st / time_s);
    rate.along += (node.weight * field.along).imag();
    rate.across += (node.weight * field.across).imag();
  }
  const double rock = whole_space_response(rock_spm, time_s);
  return {.along = kPermeability / time_s * rate.along - rock, .across = kPermeability / time_s * rate.across - rock};
}

}  // namespace patrol::sim
