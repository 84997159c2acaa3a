#include "core/sensors/tem_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace patrol {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMu0 = 4e-7 * kPi;  // V s / (A m)
constexpr int kMaxOrder = 40;

using Complex = std::complex<double>;

// Modified spherical Bessel functions i_n (finite at the origin) and k_n (decaying, here with k_0 = e^-x / x), n = 0
// ... order + 1.
using Orders = std::array<Complex, kMaxOrder + 2>;

/// Computes i_n by downward recurrence (Miller), because upward recurrence loses all digits; scaled with i_0 = sinh(x)
/// / x.
Orders bessel_i(Complex x, int order) {
  constexpr int kAhead = 12;
  Orders values{};
  const Complex inverse = 1.0 / x;
  Complex above = 0.0, here = 1e-250;
  for (int n = order + 1 + kAhead + static_cast<int>(std::abs(x)); n > 0; --n) {
    const Complex below = above + (2.0 * n + 1.0) * (inverse * here);
    above = here;
    here = below;
    if (n - 1 <= order + 1) values[static_cast<std::size_t>(n - 1)] = here;
    if (std::norm(here) > 1e200) {
      here *= 1e-100, above *= 1e-100;
      for (Complex& value : values) value *= 1e-100;
    }
  }
  const Complex scale = std::sinh(x) * inverse / values[0];
  for (int n = 0; n <= order + 1; ++n) values[static_cast<std::size_t>(n)] *= scale;
  return values;
}

Orders bessel_k(Complex x, int order) {
  Orders values{};
  const Complex inverse = 1.0 / x;
  values[0] = std::exp(-x) * inverse;
  values[1] = values[0] * (1.0 + inverse);
  for (int n = 1; n <= order; ++n) {
    const auto at = static_cast<std::size_t>(n);
    values[at + 1] = values[at - 1] + (2.0 * n + 1.0) * (inverse * values[at]);
  }
  return values;
}

/// Returns the number of multipoles that the static field of a perfect conductor needs for 1e-5. Multipole n decreases
/// as (a / R)^(2n).
int order_for(const ConductiveSphere& sphere) {
  const double fall = 2.0 * std::log(sphere.distance_m / sphere.radius_m);
  return std::clamp(static_cast<int>(std::ceil(std::log(1e5) / fall)) + 2, 3, kMaxOrder);
}

struct Field {
  Complex axial, transverse;
};

/// Returns the secondary field H of the sphere at the dipole and along it, per unit moment, at Laplace frequency `s`.
/// With g = sqrt(mu0 sigma s) in the rock and x = g R, the contribution of multipole n is
///   axial       g / (4 pi R^2) (2n + 1) n (n + 1)   TE_n k_n(x)^2
///   transverse  g^3 / (4 pi) (2n + 1) / 2         ( TE_n ((x k_n(x))' / x)^2 - TM_n k_n(x)^2 )
/// TE_n and TM_n are the reflection coefficients of the sphere from i_n into k_n: tangential E and H are continuous.
Field sphere_field(double rock_spm, const ConductiveSphere& sphere, int order, Complex s) {
  const Complex root = std::sqrt(s);
  const Complex g1 = std::sqrt(kMu0 * rock_spm) * root, g2 = std::sqrt(kMu0 * sphere.conductivity_spm) * root;
  const Complex x1 = g1 * sphere.radius_m, x2 = g2 * sphere.radius_m, x = g1 * sphere.distance_m;
  const Orders i1 = bessel_i(x1, order), i2 = bessel_i(x2, order), k1 = bessel_k(x1, order), k = bessel_k(x, order);
  const double resistance = rock_spm / sphere.conductivity_spm;
  Field field;
  for (int order_n = 1; order_n <= order; ++order_n) {
    const auto n = static_cast<std::size_t>(order_n);
    const double m = order_n;
    const Complex in2 = x2 * i2[n + 1], in1 = x1 * i1[n + 1], out1 = x1 * k1[n - 1];
    const Complex te = -(i1[n] * in2 - i2[n] * in1) / (k1[n] * (in2 + (2.0 * m + 1.0) * i2[n]) + i2[n] * out1);
    const Complex slope_i1 = in1 + (m + 1.0) * i1[n], slope_i2 = in2 + (m + 1.0) * i2[n],
                  slope_k1 = -out1 - m * k1[n];  // (x i_n)' ...
    const Complex tm =
        -(i1[n] * slope_i2 * resistance - i2[n] * slope_i1) / (k1[n] * slope_i2 * resistance - i2[n] * slope_k1);
    const Complex slope_k = k[n - 1] + m * k[n] / x, k_squared = k[n] * k[n];
    field.axial += (2.0 * m + 1.0) * m * (m + 1.0) * te * k_squared;
    field.transverse += (m + 0.5) * (te * slope_k * slope_k - tm * k_squared);
  }
  field.axial *= g1 / (4.0 * kPi * sphere.distance_m * sphere.distance_m);
  field.transverse *= g1 * g1 * g1 / (4.0 * kPi);
  return field;
}

/// Node of the inversion contour. `st` is the Laplace frequency times t; the weight includes the exponential.
struct ContourPoint {
  Complex st;
  Complex weight;
};

/// Returns Talbot's contour with the optimized parameters of [Trefethen06]. Twelve nodes, six of which mirror the
/// others. The error is 3.89^-12 = 1e-7 of the scale of the decay at time t.
std::array<ContourPoint, 6> talbot_contour() {
  std::array<ContourPoint, 6> contour;
  constexpr double kPoints = 12.0;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    const double theta = (2.0 * static_cast<double>(i) + 1.0) * kPi / kPoints;
    const double cot = 1.0 / std::tan(0.6407 * theta), sin = std::sin(0.6407 * theta);
    const Complex st = kPoints * Complex(0.5017 * theta * cot - 0.6122, 0.2645 * theta);
    const Complex slope = kPoints * Complex(0.5017 * (cot - 0.6407 * theta / (sin * sin)), 0.2645);
    contour[i] = {st, 2.0 / kPoints * std::exp(st) * slope};
  }
  return contour;
}

/// Gauss-Legendre on 0 ... 1. The ramp is longer than the first gate is late: it needs five points, a gate three.
struct Quadrature {
  double at, weight;
};
constexpr std::array<Quadrature, 3> kGauss3 = {
    {{0.11270166537925831, 5.0 / 18.0}, {0.5, 4.0 / 9.0}, {0.88729833462074169, 5.0 / 18.0}}};
constexpr std::array<Quadrature, 5> kGauss5 = {{{0.04691007703066800, 0.11846344252809454},
                                                {0.23076534494715845, 0.23931433524968324},
                                                {0.5, 0.28444444444444444},
                                                {0.76923465505284155, 0.23931433524968324},
                                                {0.95308992296933200, 0.11846344252809454}}};

}  // namespace

double whole_space_response(double rock_spm, double time_s) {
  return kMu0 * std::pow(kMu0 * rock_spm, 1.5) / (8.0 * std::pow(kPi, 1.5)) * std::pow(time_s, -2.5);
}

SphereResponse sphere_response(double rock_spm, const ConductiveSphere& sphere, double time_s) {
  const std::array<ContourPoint, 6> contour = talbot_contour();
  const int order = order_for(sphere);
  SphereResponse rate;
  for (const ContourPoint& point : contour) {
    const Field field = sphere_field(rock_spm, sphere, order, point.st / time_s);
    rate.axial += kMu0 / time_s * (point.weight * field.axial).imag();
    rate.transverse += kMu0 / time_s * (point.weight * field.transverse).imag();
  }
  return rate;
}

// The decay times t^(5/2) is smooth in log t: interpolate it by cubic Lagrange polynomials through four nodes.
TemGates::TemGates(const TemGateLayout& window) {
  constexpr double kNodesPerDecade = 9.0;
  const auto [first, last] = std::minmax_element(window.gate_s.begin(), window.gate_s.end());
  const double begin_s = *first * (1.0 - window.gate_width), end_s = *last * (1.0 + window.gate_width) + window.ramp_s;
  const int nodes = std::max(4, 1 + static_cast<int>(std::ceil(kNodesPerDecade * std::log10(end_s / begin_s))));
  const double step = std::log(end_s / begin_s) / (nodes - 1);
  for (int node = 0; node < nodes; ++node) node_s_.push_back(begin_s * std::exp(step * node));

  weights_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(window.gate_s.size()), nodes);
  for (Eigen::Index gate = 0; gate < weights_.rows(); ++gate) {
    const double middle_s = window.gate_s[static_cast<std::size_t>(gate)];
    for (const Quadrature& width : kGauss3) {
      for (const Quadrature& ramp : kGauss5) {
        const double time_s = middle_s * (1.0 + window.gate_width * (width.at - 0.5)) + window.ramp_s * ramp.at;
        const double position = std::log(time_s / begin_s) / step;
        const int base = std::clamp(static_cast<int>(position) - 1, 0, nodes - 4);
        for (int i = 0; i < 4; ++i) {
          double lagrange = 1.0;
          for (int j = 0; j < 4; ++j) lagrange *= i == j ? 1.0 : (position - base - j) / (i - j);
          weights_(gate, base + i) += width.weight * ramp.weight * lagrange *
                                      std::pow(node_s_[static_cast<std::size_t>(base + i)] / time_s, 2.5);
        }
      }
    }
  }
}

Eigen::VectorXd gated_whole_space_response(const TemGates& gates, double rock_spm) {
  Eigen::VectorXd rate(static_cast<Eigen::Index>(gates.node_s().size()));
  for (Eigen::Index node = 0; node < rate.size(); ++node)
    rate[node] = whole_space_response(rock_spm, gates.node_s()[static_cast<std::size_t>(node)]);
  return gates.gated(rate);
}

GatedSphereResponse gated_sphere_response(const TemGates& gates, double rock_spm, const ConductiveSphere& sphere) {
  const auto nodes = static_cast<Eigen::Index>(gates.node_s().size());
  Eigen::VectorXd axial(nodes), transverse(nodes);
  for (Eigen::Index node = 0; node < nodes; ++node) {
    const SphereResponse rate = sphere_response(rock_spm, sphere, gates.node_s()[static_cast<std::size_t>(node)]);
    axial[node] = rate.axial;
    transverse[node] = rate.transverse;
  }
  return {.axial = gates.gated(axial), .transverse = gates.gated(transverse)};
}

}  // namespace patrol
