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

/// Two numbers in one register.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

/// Two complex numbers. Their sizes are moderate: products and quotients need no scaling.
struct Complex {
  Pair re, im;
};

Complex constant(double value) { return {Pair{value, value}, Pair{0.0, 0.0}}; }

inline Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
inline Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
inline Complex operator*(double a, const Complex& b) { return {a * b.re, a * b.im}; }
inline Complex operator*(const Complex& a, const Complex& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

inline Complex inverse(const Complex& a) {
  const Pair scale = 1.0 / (a.re * a.re + a.im * a.im);
  return {a.re * scale, -a.im * scale};
}

Complex exp(const Complex& a) {
  const std::complex<double> first = std::exp(std::complex<double>(a.re[0], a.im[0])),
                             second = std::exp(std::complex<double>(a.re[1], a.im[1]));
  return {Pair{first.real(), second.real()}, Pair{first.imag(), second.imag()}};
}

/// Modified spherical Bessel functions i_n that are finite at the origin: `value` is i_n (2n + 1)!! / x^n up to a
/// factor common to all n, `next` that of x i_(n+1), n = 0 ... order.
struct BesselI {
  std::array<Complex, kMaxOrder + 1> value, next;
};

/// Computes them by downward recurrence (Miller), because upward recurrence loses all digits.
void bessel_i(const Complex& x, int order, BesselI& i) {
  constexpr int kAhead = 8;
  const Complex x_squared = x * x;
  const Pair square = x.re * x.re + x.im * x.im;
  int n = order + kAhead + static_cast<int>(std::sqrt(std::max(square[0], square[1])));
  Complex above = constant(1.0), here = above;
  for (double above_inverse = 1.0 / (2.0 * n + 3.0); n >= 0; --n) {
    const Complex next = above_inverse * (x_squared * above);
    above_inverse = 1.0 / (2.0 * n + 1.0);
    if (n <= order) {
      i.value[static_cast<std::size_t>(n)] = here;
      i.next[static_cast<std::size_t>(n)] = next;
    }
    above = here;
    here = here + above_inverse * next;
  }
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

/// Returns the secondary field H of the sphere at the dipole and along it, per unit moment, at Laplace frequency s with
/// `root` = sqrt(mu0 s). With g = sqrt(mu0 sigma s) in the rock and x = g R, the contribution of multipole n is
///   axial       g / (4 pi R^2) (2n + 1) n (n + 1)   TE_n k_n(x)^2
///   transverse  g^3 / (4 pi) (2n + 1) / 2         ( TE_n ((x k_n(x))' / x)^2 - TM_n k_n(x)^2 )
/// k_n are the decaying modified spherical Bessel functions with k_0 = e^-x / x. TE_n and TM_n are the reflection
/// coefficients of the sphere from i_n into k_n: tangential E and H are continuous. All functions are free of their
/// powers of x and double factorials, of which (a / R)^(2n + 1) / (2n + 1) remains: i_n as above, and k_n with the
/// factor x^(n + 1) / (2n - 1)!! e^x, which follows from upward recurrence.
Field sphere_field(double rock_spm, const ConductiveSphere& sphere, int order, const Complex& root) {
  const Complex g1 = std::sqrt(rock_spm) * root, g2 = std::sqrt(sphere.conductivity_spm) * root;
  const Complex x1 = sphere.radius_m * g1, x2 = sphere.radius_m * g2, x = sphere.distance_m * g1;
  BesselI i1, i2;
  bessel_i(x1, order, i1);
  bessel_i(x2, order, i2);
  const double resistance = rock_spm / sphere.conductivity_spm, ratio = sphere.radius_m / sphere.distance_m;
  const Complex x1_squared = x1 * x1, x_squared = x * x;
  // Functions of order n - 1 and n.
  Complex k1_below = constant(1.0), k1 = k1_below + x1, k_below = constant(1.0), k = k_below + x;
  // The Wronskian i_0 k_1 + i_1 k_0 = x^-2 yields the factor of `i1`.
  const Complex factor = exp(2.0 * (x1 - x)) * inverse(x * (i1.value[0] * k1 + i1.next[0]));
  const Complex inverse_x_squared = inverse(x_squared);
  double power = ratio;
  Field field{constant(0.0), constant(0.0)};
  for (int order_n = 1; order_n <= order; ++order_n) {
    const auto n = static_cast<std::size_t>(order_n);
    const double m = order_n;
    power *= ratio * ratio;
    // x k_(n-1) as the others: without the factor of k_n.
    const Complex out1 = 1.0 / (2.0 * m - 1.0) * (x1_squared * k1_below),
                  out = 1.0 / (2.0 * m - 1.0) * (x_squared * k_below);
    const Complex &in1 = i1.value[n], &in2 = i2.value[n];
    const Complex te =
        (i1.next[n] * in2 - in1 * i2.next[n]) * inverse(k1 * ((2.0 * m + 1.0) * in2 + i2.next[n]) + in2 * out1);
    const Complex slope_i1 = (m + 1.0) * in1 + i1.next[n], slope_i2 = resistance * ((m + 1.0) * in2 + i2.next[n]),
                  slope_k1 = m * k1 + out1, slope_k = m * k + out;  // (x i_n)' ..., -(x k_n)'
    const Complex tm = (slope_i1 * in2 - in1 * slope_i2) * inverse(k1 * slope_i2 + in2 * slope_k1);
    const Complex k_squared = k * k;
    field.axial = field.axial + power * m * (m + 1.0) * (te * k_squared);
    field.transverse = field.transverse + 0.5 * power * (te * slope_k * slope_k * inverse_x_squared - tm * k_squared);
    k1_below = k1, k_below = k;
    k1 = k1 + 1.0 / (2.0 * m + 1.0) * out1;
    k = k + 1.0 / (2.0 * m + 1.0) * out;
  }
  field.axial = 1.0 / (4.0 * kPi * sphere.distance_m * sphere.distance_m) * (g1 * factor * field.axial);
  field.transverse = 1.0 / (4.0 * kPi) * (g1 * g1 * g1 * factor * field.transverse);
  return field;
}

/// Two nodes of the inversion contour for time t. The weight includes the exponential.
struct ContourPair {
  Complex root;  ///< sqrt(mu0 s t)
  Complex weight;
};

/// Returns Talbot's contour with the optimized parameters of [Trefethen06]. Twelve nodes, six of which mirror the
/// others. The error is 3.89^-12 = 1e-7 of the scale of the decay at time t.
std::array<ContourPair, 3> talbot_contour() {
  std::array<ContourPair, 3> contour;
  constexpr double kPoints = 12.0;
  for (std::size_t i = 0; i < 2 * contour.size(); ++i) {
    const double theta = (2.0 * static_cast<double>(i) + 1.0) * kPi / kPoints;
    const double cot = 1.0 / std::tan(0.6407 * theta), sin = std::sin(0.6407 * theta);
    const std::complex<double> st = kPoints * std::complex<double>(0.5017 * theta * cot - 0.6122, 0.2645 * theta);
    const std::complex<double> slope =
        kPoints * std::complex<double>(0.5017 * (cot - 0.6407 * theta / (sin * sin)), 0.2645);
    const std::complex<double> root = std::sqrt(kMu0 * st), weight = 2.0 / kPoints * std::exp(st) * slope;
    ContourPair& pair = contour[i / 2];
    pair.root.re[i % 2] = root.real(), pair.root.im[i % 2] = root.imag();
    pair.weight.re[i % 2] = weight.real(), pair.weight.im[i % 2] = weight.imag();
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
  static const std::array<ContourPair, 3> contour = talbot_contour();
  const int order = order_for(sphere);
  SphereResponse rate;
  for (const ContourPair& pair : contour) {
    const Field field = sphere_field(rock_spm, sphere, order, 1.0 / std::sqrt(time_s) * pair.root);
    const Pair axial = (pair.weight * field.axial).im, transverse = (pair.weight * field.transverse).im;
    rate.axial += kMu0 / time_s * (axial[0] + axial[1]);
    rate.transverse += kMu0 / time_s * (transverse[0] + transverse[1]);
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
