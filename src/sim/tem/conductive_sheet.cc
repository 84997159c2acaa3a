#include "sim/tem/conductive_sheet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/tem/laplace_inversion.h"
#include "sim/tem/permeability.h"

namespace patrol::sim {
namespace {

using Complex = std::complex<double>;

}  // namespace

AxialTensor<Complex> sheet_field(double rock_spm, double conductance_s, double distance_m, Complex frequency) {
  const Complex impedance = kPermeability * frequency, gamma_squared = impedance * rock_spm;
  // Trapezoidal rule in ln k: the integrand falls as k^2 below and as e^(-2 k h) above.
  constexpr double kStep = 0.05, kLargest = 20.0;
  const double smallest = 1e-6 * std::min(1.0, std::abs(impedance * conductance_s) * distance_m);
  AxialTensor<Complex> field;
  for (double x = kLargest; x > smallest; x *= std::exp(-kStep)) {
    const double k = x / distance_m;
    const Complex u = std::sqrt(k * k + gamma_squared), fall = kStep * k * std::exp(-2.0 * u * distance_m);
    const Complex te = -conductance_s * impedance / (2.0 * u + conductance_s * impedance),
                  tm = conductance_s * u / (2.0 * rock_spm + conductance_s * u);
    field.along += fall * te * (k * k * k) / u;
    field.across += 0.5 * fall * k * (te * u - tm * gamma_squared / u);
  }
  field.along /= 4.0 * std::numbers::pi;
  field.across /= 4.0 * std::numbers::pi;
  return field;
}

AxialTensor<double> sheet_response(double rock_spm, double conductance_s, double distance_m, double time_s) {
  if (conductance_s <= 0.0) return {};
  AxialTensor<double> rate;
  for (const LaplaceNode& node : laplace_nodes()) {
    const AxialTensor<Complex> field = sheet_field(rock_spm, conductance_s, distance_m, node.st / time_s);
    rate.along += kPermeability / time_s * (node.weight * field.along).imag();
    rate.across += kPermeability / time_s * (node.weight * field.across).imag();
  }
  return rate;
}

}  // namespace patrol::sim
