#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace patrol::sim {

/// Node of the contour of the inverse Laplace transform. `st` is the Laplace frequency times t.
struct LaplaceNode {
  std::complex<double> st;
  std::complex<double> weight;  ///< includes the exponential
};

/// Half of the nodes; the other half mirrors them at the real axis.
inline constexpr std::size_t kLaplaceNodes = 7;

/// Returns Talbot's contour with the parameters of [Trefethen06, table 1]. The error is 3.89^-14 = 6e-9 of the scale of
/// the transform at the time t.
inline std::array<LaplaceNode, kLaplaceNodes> laplace_nodes() {
  std::array<LaplaceNode, kLaplaceNodes> nodes;
  constexpr double kPoints = 2.0 * kLaplaceNodes;
  for (std::size_t i = 0; i < kLaplaceNodes; ++i) {
    const double theta = (2.0 * static_cast<double>(i) + 1.0) * std::numbers::pi / kPoints, angle = 0.6407 * theta;
    const double cot = 1.0 / std::tan(angle), sine = std::sin(angle);
    const std::complex<double> st = kPoints * std::complex<double>(0.5017 * theta * cot - 0.6122, 0.2645 * theta);
    const std::complex<double> slope = kPoints * std::complex<double>(0.5017 * (cot - angle / (sine * sine)), 0.2645);
    nodes[i] = {st, 2.0 / kPoints * std::exp(st) * slope};
  }
  return nodes;
}

}  // namespace patrol::sim
