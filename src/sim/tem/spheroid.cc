#include "sim/tem/spheroid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "sim/tem/permeability.h"
#include "sim/tem/spherical_bessel.h"

namespace patrol::sim {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr int kNodes = 48;

/// Nodes and weights of Gauss-Legendre quadrature over cos(theta).
struct Quadrature {
  Eigen::VectorXd cosine, weight;
};

Quadrature gauss_legendre(int count) {
  Quadrature quadrature{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (int i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 0.0;
    for (int step = 0; step < 100; ++step) {
      double before = 0.0, here = 1.0;
      for (int n = 1; n <= count; ++n) {
        const double next = ((2.0 * n - 1.0) * x * here - (n - 1.0) * before) / n;
        before = here;
        here = next;
      }
      slope = count * (x * here - before) / (x * x - 1.0);
      const double change = here / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    quadrature.cosine[i] = x;
    quadrature.weight[i] = 2.0 / ((1.0 - x * x) * slope * slope);
  }
  return quadrature;
}

/// Angular functions of one azimuthal order m: P_n^m, m P_n^m / sin(theta) and dP_n^m / dtheta, normalized to n (n + 1)
/// times the integral of (P_n^m)^2 over cos(theta) = 1; [degree - first].
struct AngularFunctions {
  std::vector<double> P, pi, tau;

  AngularFunctions(int m, int order, double cosine, double sine) {
    double here = std::sqrt(0.5);
    for (int i = 1; i <= m; ++i) here *= std::sqrt((2.0 * i + 1.0) / (2.0 * i)) * sine;
    double before = 0.0;
    const auto ratio = [m](int n) { return std::sqrt((4.0 * n * n - 1.0) / (1.0 * n * n - 1.0 * m * m)); };
    for (int n = m; n <= order; ++n) {
      if (n > m) {
        const double next = ratio(n) * (cosine * here - (n > m + 1 ? before / ratio(n - 1) : 0.0));
        before = here;
        here = next;
      }
      if (n == 0) continue;
      const double norm = 1.0 / std::sqrt(n * (n + 1.0));
      const double slope =
          n * cosine * here - (n > m ? (2.0 * n + 1.0) / ratio(n) * before : 0.0);  // sin(theta) dP / dtheta
      P.push_back(norm * here);
      pi.push_back(norm * m * here / sine);
      tau.push_back(norm * slope / sine);
    }
  }
};

/// Tangential components of the functions of one kind on the surface, [node][degree]: z pi and z tau of the TE
/// functions, D pi and the meridional component D tau + (r' / r) n (n + 1) z / x P of the TM functions.
struct SurfaceFunctions {
  MatrixXcd z_pi, z_tau, d_pi, d_tau;

  explicit SurfaceFunctions(Index degrees)
      : z_pi(kNodes, degrees), z_tau(kNodes, degrees), d_pi(kNodes, degrees), d_tau(kNodes, degrees) {}

  void set(Index node, Index at, double degree, const AngularFunctions& angular, Complex z, Complex d, Complex x,
           double slope) {
    const auto i = static_cast<std::size_t>(at);
    z_pi(node, at) = z * angular.pi[i];
    z_tau(node, at) = z * angular.tau[i];
    d_pi(node, at) = d * angular.pi[i];
    d_tau(node, at) = d * angular.tau[i] + slope * degree * (degree + 1.0) * z / x * angular.P[i];
  }
};

/// Returns <A, B> for all functions of A (rock) and B (inside); `weight`: quadrature weight times r^2, [node].
MatrixXcd surface_products(const SurfaceFunctions& a, Complex gamma_a, const SurfaceFunctions& b, Complex gamma_b,
                           const Eigen::VectorXd& weight) {
  const Index n = a.z_pi.cols();
  const auto product = [&](const MatrixXcd& left, const MatrixXcd& right) -> MatrixXcd {
    return left.transpose() * weight.asDiagonal() * right;
  };
  const MatrixXcd zz = product(a.z_pi, b.z_tau) + product(a.z_tau, b.z_pi),
                  dd = product(a.d_pi, b.d_tau) + product(a.d_tau, b.d_pi),
                  zd = product(a.z_pi, b.d_pi) + product(a.z_tau, b.d_tau),
                  dz = product(a.d_pi, b.z_pi) + product(a.d_tau, b.z_tau);
  MatrixXcd result(2 * n, 2 * n);
  result << gamma_b * zd - gamma_a * dz, gamma_b * zz - gamma_a * dd,  //
      gamma_b * dd - gamma_a * zz, gamma_b * dz - gamma_a * zd;
  return result;
}

/// Distance of the surface from the center and its relative slope dr / dtheta / r, at the quadrature nodes.
struct Surface {
  Quadrature quadrature = gauss_legendre(kNodes);
  Eigen::VectorXd radius_m, slope;

  explicit Surface(const ConductiveSpheroid& spheroid) : radius_m(kNodes), slope(kNodes) {
    const double polar = std::pow(spheroid.polar_m, -2.0), equatorial = std::pow(spheroid.equatorial_m, -2.0);
    for (Index i = 0; i < kNodes; ++i) {
      const double c = quadrature.cosine[i], s = std::sqrt(1.0 - c * c);
      radius_m[i] = 1.0 / std::sqrt(c * c * polar + s * s * equatorial);
      slope[i] = radius_m[i] * radius_m[i] * s * c * (polar - equatorial);
    }
  }
};

/// Bessel functions at all nodes and at the reference radius that scales them.
struct RadialFunctions {
  std::vector<SphericalBessel> rock, inside;  ///< [node]
  SphericalBessel rock_scale, inside_scale;

  RadialFunctions(const Surface& surface, Complex gamma_rock, Complex gamma_inside, double scale_m, int order)
      : rock_scale(gamma_rock * scale_m, order), inside_scale(gamma_inside * scale_m, order) {
    for (const double radius_m : surface.radius_m) {
      rock.emplace_back(gamma_rock * radius_m, order);
      inside.emplace_back(gamma_inside * radius_m, order);
    }
  }
};

/// Returns the T-matrix of azimuthal order m.
MatrixXcd t_matrix(int m, int order, const Surface& surface, const RadialFunctions& radial, Complex gamma_rock,
                   Complex gamma_inside) {
  const int first = std::max(1, m);
  const Index degrees = order - first + 1;
  SurfaceFunctions regular(degrees), decaying(degrees), inside(degrees);
  for (Index node = 0; node < kNodes; ++node) {
    const double cosine = surface.quadrature.cosine[node], slope = surface.slope[node];
    const AngularFunctions angular(m, order, cosine, std::sqrt(1.0 - cosine * cosine));
    const SphericalBessel &rock = radial.rock[static_cast<std::size_t>(node)],
                          &in = radial.inside[static_cast<std::size_t>(node)];
    const Complex x_rock = gamma_rock * surface.radius_m[node], x_in = gamma_inside * surface.radius_m[node];
    for (Index at = 0; at < degrees; ++at) {
      const auto n = static_cast<std::size_t>(first + at);
      const auto degree = static_cast<double>(n);
      const Complex i = radial.rock_scale.i[n], k = radial.rock_scale.k[n], i_in = radial.inside_scale.i[n];
      regular.set(node, at, degree, angular, rock.i[n] / i, rock.i_slope[n] / i, x_rock, slope);
      decaying.set(node, at, degree, angular, rock.k[n] / k, rock.k_slope[n] / k, x_rock, slope);
      inside.set(node, at, degree, angular, in.i[n] / i_in, in.i_slope[n] / i_in, x_in, slope);
    }
  }
  const Eigen::VectorXd weight = surface.quadrature.weight.cwiseProduct(surface.radius_m.cwiseAbs2());
  const MatrixXcd P = surface_products(regular, gamma_rock, inside, gamma_inside, weight),
                  Q = surface_products(decaying, gamma_rock, inside, gamma_inside, weight);
  // P Q^-1 = (Q^-T P^T)^T. Undo the scaling of the regular and decaying functions and apply the signs S.
  MatrixXcd T = -Q.transpose().partialPivLu().solve(P.transpose()).transpose();
  for (Index row = 0; row < 2 * degrees; ++row) {
    const auto n = static_cast<std::size_t>(first + row % degrees);
    const double sign = row < degrees ? -1.0 : 1.0;
    T.row(row) *= sign * radial.rock_scale.i[n];
    T.col(row) *= sign / radial.rock_scale.k[n];
  }
  return T;
}

}  // namespace

SpheroidScattering::SpheroidScattering(double rock_spm, const ConductiveSpheroid& spheroid, Complex frequency,
                                       int order)
    : gamma_(std::sqrt(kPermeability * rock_spm * frequency)), order_(order) {
  const Complex gamma_inside = std::sqrt(kPermeability * spheroid.conductivity_spm * frequency);
  const Surface surface(spheroid);
  const double scale_m = std::cbrt(spheroid.polar_m * spheroid.equatorial_m * spheroid.equatorial_m);
  const RadialFunctions radial(surface, gamma_, gamma_inside, scale_m, order);
  for (int m = 0; m <= order; ++m) T_.push_back(t_matrix(m, order, surface, radial, gamma_, gamma_inside));
}

// A dipole along u excites regular function v with the amplitude mu0 s (u curl O_v) / c_v, and the scattered function v
// has the field -(u curl O_v) / (mu0 s) at the dipole (reciprocity theorem), with c_v = -+ e_m / gamma for TE and TM
// functions; e_m is the integral of cos^2(m phi).
Eigen::Matrix3cd SpheroidScattering::field_at_dipole(const Eigen::Vector3d& p_m) const {
  const double distance_m = p_m.norm(), across_m = p_m.head<2>().norm();
  // The limit on the axis is approached within 1e-6 rad.
  const double sine = std::max(across_m / distance_m, 1e-6);
  const double cosine = std::copysign(std::sqrt(1.0 - sine * sine), p_m.z());
  const Complex x = gamma_ * distance_m;
  const SphericalBessel bessel(x, order_);
  Eigen::Matrix3cd G = Eigen::Matrix3cd::Zero();  // components r, theta, phi
  for (int m = 0; m <= order_; ++m) {
    const AngularFunctions angular(m, order_, cosine, sine);
    const int first = std::max(1, m);
    const Index degrees = order_ - first + 1;
    // Curls of the functions, [function][component]; the two classes of functions differ by a quarter period of phi.
    MatrixXcd meridional = MatrixXcd::Zero(2 * degrees, 3), azimuthal = MatrixXcd::Zero(2 * degrees, 3);
    for (Index at = 0; at < degrees; ++at) {
      const auto i = static_cast<std::size_t>(at), n = static_cast<std::size_t>(first + at);
      const Complex k = bessel.k[n], slope = bessel.k_slope[n];
      const double degree = static_cast<double>(n);
      meridional(at, 0) = -gamma_ * degree * (degree + 1.0) * k / x * angular.P[i];
      meridional(at, 1) = -gamma_ * slope * angular.tau[i];
      meridional(degrees + at, 1) = -gamma_ * k * angular.pi[i];
      azimuthal(at, 2) = gamma_ * slope * angular.pi[i];
      azimuthal(degrees + at, 2) = gamma_ * k * angular.tau[i];
    }
    MatrixXcd T = T_[static_cast<std::size_t>(m)];
    T.leftCols(degrees) *= -1.0;
    const double period = m == 0 ? 2.0 * std::numbers::pi : std::numbers::pi;
    G -= gamma_ / period * (meridional.transpose() * T * meridional + azimuthal.transpose() * T * azimuthal);
  }
  const double azimuth = across_m > 0.0 ? std::atan2(p_m.y(), p_m.x()) : 0.0;
  Eigen::Matrix3d axes;  // columns: unit vectors r, theta, phi
  axes << sine * std::cos(azimuth), cosine * std::cos(azimuth), -std::sin(azimuth),  //
      sine * std::sin(azimuth), cosine * std::sin(azimuth), std::cos(azimuth),       //
      cosine, -sine, 0.0;
  return axes.cast<Complex>() * G * axes.transpose().cast<Complex>();
}

}  // namespace patrol::sim
