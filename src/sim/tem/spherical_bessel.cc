#include "sim/tem/spherical_bessel.h"

#include <cmath>
#include <cstddef>

namespace patrol::sim {

/// i_n from its ratios r_n = i_(n+1) / i_n, which the recurrence r_(n-1) = 1 / ((2n + 1) / x + r_n) yields stably
/// downwards; k_n by upward recurrence.
SphericalBessel::SphericalBessel(std::complex<double> x, int max_order) {
  const auto count = static_cast<std::size_t>(max_order) + 1;
  const std::complex<double> inverse = 1.0 / x;
  std::vector<std::complex<double>> ratio(count);
  std::complex<double> r = 0.0;
  for (int n = max_order + 20 + static_cast<int>(std::abs(x)); n > 0; --n) {
    r = 1.0 / ((2.0 * n + 1.0) * inverse + r);
    if (n <= max_order) ratio[static_cast<std::size_t>(n) - 1] = r;
  }
  i.resize(count), k.resize(count), i_slope.resize(count), k_slope.resize(count);
  i[0] = std::sinh(x) * inverse;
  k[0] = std::exp(-x) * inverse;
  i_slope[0] = std::cosh(x) * inverse;
  k_slope[0] = -k[0];
  for (std::size_t n = 1; n < count; ++n) {
    const auto order = static_cast<double>(n);
    i[n] = ratio[n - 1] * i[n - 1];
    k[n] = n == 1 ? k[0] * (1.0 + inverse) : k[n - 2] + (2.0 * order - 1.0) * inverse * k[n - 1];
    i_slope[n] = i[n - 1] - order * inverse * i[n];
    k_slope[n] = -k[n - 1] - order * inverse * k[n];
  }
}

}  // namespace patrol::sim
