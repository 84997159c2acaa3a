#pragma once

#include <complex>
#include <vector>

namespace patrol::sim {

/// Modified spherical Bessel functions of orders 0 ... max_order at one argument: i_n (finite at the origin, i_0 = sinh
/// x / x), k_n (decaying, k_0 = e^-x / x), and their Riccati slopes (x z_n)' / x.
struct SphericalBessel {
  std::vector<std::complex<double>> i, k, i_slope, k_slope;  ///< [order]

  SphericalBessel(std::complex<double> x, int max_order);
};

}  // namespace patrol::sim
