#include "sim/tem/spheroid.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/sensors/tem_response.h"
#include "sim/tem/laplace_inversion.h"

namespace patrol::sim::spheroid_test {
namespace {

constexpr double kMu0 = 4e-7 * std::numbers::pi;

Eigen::Matrix3d rate(double rock_spm, const ConductiveSpheroid& spheroid, const Eigen::Vector3d& p_m, double time_s,
                     int order = 12) {
  Eigen::Matrix3d rate = Eigen::Matrix3d::Zero();
  for (const LaplaceNode& node : laplace_nodes()) {
    const SpheroidScattering scattering(rock_spm, spheroid, node.st / time_s, order);
    rate += kMu0 / time_s * (node.weight * scattering.field_at_dipole(p_m)).imag();
  }
  return rate;
}

// The tolerance is that of the inverse Laplace transform of the sphere's solution, 1e-7 of the early response.
TEST(Spheroid, WithEqualAxesIsTheSphereInEveryDirection) {
  for (const double time_s : {2e-6, 2e-5}) {
    const SphereResponse sphere = sphere_response(0.003, {18.0, 6.0, 0.6}, time_s);
    const double tol = 1e-7 * sphere_response(0.003, {18.0, 6.0, 0.6}, 2e-6).axial * std::min(1.0, 2e-6 / time_s);
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, -2, 2).normalized().eval()}) {
      const Eigen::Matrix3d G = rate(0.003, {6.0, 6.0, 0.6}, 18.0 * direction, time_s),
                            along = direction * direction.transpose();
      const Eigen::Matrix3d expected = sphere.axial * along + sphere.transverse * (Eigen::Matrix3d::Identity() - along);
      EXPECT_LT((G - expected).norm(), 3.0 * tol + 1e-4 * expected.norm()) << time_s << " s, " << direction.transpose();
    }
  }
}

TEST(Spheroid, ResponseIsSymmetricByReciprocityAndConvergesWithTheOrder) {
  const Eigen::Vector3d p_m = 18.0 * Eigen::Vector3d(1, 2, 2).normalized();
  for (const ConductiveSpheroid& spheroid : {ConductiveSpheroid{4.0, 8.0, 0.6}, {8.0, 4.0, 0.6}}) {
    for (const double time_s : {2e-6, 2e-5}) {
      const Eigen::Matrix3d twelve = rate(0.003, spheroid, p_m, time_s),
                            fourteen = rate(0.003, spheroid, p_m, time_s, 14);
      EXPECT_LT((twelve - twelve.transpose()).norm(), 1e-4 * twelve.norm());
      EXPECT_LT((twelve - fourteen).norm(), 5e-4 * fourteen.norm());
    }
  }
}

// Weak induction in a uniform field: E inside is linear, without current through the surface. The moments per unit
// field are -mu0 s sigma V a^2 / 10 along the axis and -mu0 s sigma V a^2 c^2 / (5 (a^2 + c^2)) across it.
TEST(Spheroid, AtLowFrequencyInAnInsulatorHasTheMomentOfTheInducedCurrents) {
  constexpr double kFrequency = 100.0, kDistance_m = 600.0, kConductivity = 0.6;
  for (const auto& [polar_m, equatorial_m] : {std::pair{3.0, 6.0}, {8.0, 4.0}}) {
    // The rock is far more resistive than air is in practice: currents that the body draws from it would respond, too.
    const SpheroidScattering scattering(1e-12, {polar_m, equatorial_m, kConductivity}, kFrequency, 8);
    const double a2 = equatorial_m * equatorial_m, c2 = polar_m * polar_m;
    const double strength =
        kMu0 * kFrequency * kConductivity * 4.0 / 3.0 * std::numbers::pi * a2 * polar_m;  // mu0 s sigma V
    const double axial = -strength * a2 / 10.0, across = -strength * a2 * c2 / (5.0 * (a2 + c2));
    // Fields of a dipole at the distance: 1 / (2 pi R^3) along the line of sight, -1 / (4 pi R^3) across it.
    const double ahead = std::pow(2.0 * std::numbers::pi * std::pow(kDistance_m, 3), -2), aside = ahead / 4.0;
    const Eigen::Matrix3cd on_axis = scattering.field_at_dipole({0.0, 0.0, kDistance_m}),
                           beside = scattering.field_at_dipole({kDistance_m, 0.0, 0.0});
    EXPECT_NEAR(on_axis(2, 2).real(), ahead * axial, 2e-3 * std::abs(ahead * axial));
    EXPECT_NEAR(on_axis(0, 0).real(), aside * across, 2e-3 * std::abs(aside * across));
    EXPECT_NEAR(beside(0, 0).real(), ahead * across, 2e-3 * std::abs(ahead * across));
    EXPECT_NEAR(beside(2, 2).real(), aside * axial, 2e-3 * std::abs(aside * axial));
  }
}

TEST(Spheroid, WithTheConductivityOfTheRockDoesNotRespond) {
  const Eigen::Vector3d p_m(0.0, 12.0, 12.0);
  EXPECT_LT(rate(0.003, {4.0, 8.0, 0.003}, p_m, 2e-6).norm(), 1e-7 * rate(0.003, {4.0, 8.0, 0.6}, p_m, 2e-6).norm());
}

}  // namespace
}  // namespace patrol::sim::spheroid_test
