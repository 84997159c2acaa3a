#include "core/sensors/tem_response.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace patrol::tem_response_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMu0 = 4e-7 * kPi;
constexpr double kNoRock = 1e-9;  // S/m

double decay_time(const ConductiveSphere& sphere) {
  return kMu0 * sphere.conductivity_spm * sphere.radius_m * sphere.radius_m / (kPi * kPi);
}

/// What a uniform field, switched off, leaves of a small far sphere's dipole: B0 6 / pi^2 sum exp(-n^2 t / tau) / n^2
/// (Wait 1951); -dB/dt.
double far_sphere_rate(const ConductiveSphere& sphere, double time_s) {
  const double field = kMu0 * 2.0 * std::pow(sphere.radius_m, 3) / (4.0 * kPi * std::pow(sphere.distance_m, 6));
  const double tau_s = decay_time(sphere);
  double sum = 0.0;
  for (int n = 1; n < 200; ++n) sum += std::exp(-n * n * time_s / tau_s);
  return field * 6.0 / (kPi * kPi * tau_s) * sum;
}

/// What a cubic metre at `p`, that conducts better than the rock by 1 S/m, adds to first order for a coil at the origin
/// along `axis`. By reciprocity its field at the coil is -s mu0 E^2, E = mu0 (1 + g r) exp(-g r) sin(theta) / (4 pi
/// r^2) of the dipole, g = sqrt(mu0 sigma s); term by term back in time, with u = mu0 sigma r^2 / t, s (1 + g r)^2
/// exp(-2 g r) is -pi^(-1/2) t^-2 exp(-u) (5/4 u^(3/2) + 3 u^(5/2) - u^(7/2)).
double born_rate(double rock_spm, const Eigen::Vector3d& p, const Eigen::Vector3d& axis, double time_s) {
  const double r = p.norm(), cosine = p.dot(axis) / r, u = kMu0 * rock_spm * r * r / time_s;
  const double decay = std::exp(-u) * (1.25 * std::pow(u, 1.5) + 3.0 * std::pow(u, 2.5) - std::pow(u, 3.5)) /
                       (std::sqrt(kPi) * time_s * time_s);
  return kMu0 * kMu0 / (16.0 * kPi * kPi) * (1.0 - cosine * cosine) / std::pow(r, 4) * decay;
}

/// The sum of that over a sphere.
double weak_sphere_rate(double rock_spm, const ConductiveSphere& sphere, const Eigen::Vector3d& axis, double time_s) {
  constexpr int kSteps = 30;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      for (int k = 0; k < kSteps; ++k) {
        const double radius = sphere.radius_m * std::cbrt((i + 0.5) / kSteps), cosine = 2.0 * (j + 0.5) / kSteps - 1.0;
        const double turn = 2.0 * kPi * (k + 0.5) / kSteps, across = radius * std::sqrt(1.0 - cosine * cosine);
        sum +=
            born_rate(rock_spm, {sphere.distance_m + radius * cosine, across * std::cos(turn), across * std::sin(turn)},
                      axis, time_s);
      }
    }
  }
  return 4.0 / 3.0 * kPi * std::pow(sphere.radius_m, 3) / std::pow(kSteps, 3) * (sphere.conductivity_spm - rock_spm) *
         sum;
}

// All rock better by d sigma adds d sigma times the sum over all space; shells of sin^2 = 2/3 on average. 3/2 of the
// rate itself, over sigma.
TEST(TemResponse, TheRocksRateGrowsWithItsConductivityAsTheBornIntegralSays) {
  const double time_s = 1e-5, step_m = 0.05;
  const Eigen::Vector3d axis(std::sqrt(1.0 / 3.0), std::sqrt(2.0 / 3.0), 0.0);
  double sum = 0.0;
  for (double r = step_m / 2.0; r < 300.0; r += step_m)
    sum += 4.0 * kPi * r * r * step_m * born_rate(0.003, {r, 0.0, 0.0}, axis, time_s);
  EXPECT_NEAR(sum / (1.5 * whole_space_response(0.003, time_s) / 0.003), 1.0, 1e-3);
}

TEST(TemResponse, ASphereOfRockInRockIsNotThere) {
  const SphereResponse rate = sphere_response(0.003, {16.0, 6.0, 0.003}, 1e-5);
  EXPECT_LT(std::abs(rate.axial) + std::abs(rate.transverse), 1e-10 * whole_space_response(0.003, 1e-5));
}

TEST(TemResponse, AWeakSphereInRockDoesWhatTheBornIntegralSaysToOnePerCent) {
  const ConductiveSphere sphere{.distance_m = 16.0, .radius_m = 6.0, .conductivity_spm = 0.003 * 1.001};
  for (const double time_s : {1e-6, 4e-6, 2e-5}) {
    const SphereResponse rate = sphere_response(0.003, sphere, time_s);
    const double axial = weak_sphere_rate(0.003, sphere, Eigen::Vector3d::UnitX(), time_s);
    const double transverse = weak_sphere_rate(0.003, sphere, Eigen::Vector3d::UnitY(), time_s);
    const double tol = 0.01 * (std::abs(axial) + std::abs(transverse));
    EXPECT_NEAR(rate.axial, axial, tol) << time_s;
    EXPECT_NEAR(rate.transverse, transverse, tol) << time_s;
  }
}

// Higher multipoles are smaller by (a / R)^2 = 6e-4.
TEST(TemResponse, ASmallFarSphereInTheVoidDecaysAsWaitsSumSays) {
  const ConductiveSphere sphere{.distance_m = 40.0, .radius_m = 1.0, .conductivity_spm = 0.6};
  for (const double share : {0.2, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    const double time_s = share * decay_time(sphere);
    const SphereResponse rate = sphere_response(kNoRock, sphere, time_s);
    EXPECT_NEAR(rate.axial / far_sphere_rate(sphere, time_s), 1.0, 3e-3) << share;
    EXPECT_NEAR(rate.axial / rate.transverse, 4.0, 0.01)
        << share;  // a dipole's field: twice as strong there, and twice back
  }
}

TEST(TemResponse, LateItFallsWithTheTimeConstantMuSigmaASquaredOverPiSquared) {
  const ConductiveSphere sphere{.distance_m = 100.0, .radius_m = 6.0, .conductivity_spm = 0.6};
  const double tau_s = decay_time(sphere);  // 2.75 us
  const double fall = std::log(sphere_response(kNoRock, sphere, 5.0 * tau_s).axial /
                               sphere_response(kNoRock, sphere, 6.0 * tau_s).axial);
  EXPECT_NEAR(fall, 1.0, 1e-4);  // the next mode, of half that time constant at most and smaller by (a / R)^2, has gone
}

TEST(TemResponse, TwiceAsFarIsTwoToTheSixthAsWeak) {
  const SphereResponse near = sphere_response(kNoRock, {60.0, 2.0, 0.6}, 2e-6),
                       far = sphere_response(kNoRock, {120.0, 2.0, 0.6}, 2e-6);
  EXPECT_NEAR(near.axial / far.axial, 64.0, 0.01 * 64.0);
  EXPECT_NEAR(near.transverse / far.transverse, 64.0, 0.01 * 64.0);
}

// Just after the switch-off nothing has decayed: the field is that of a perfect conductor, mu0 2 a^3 / (4 pi R^6), and
// all of it decays.
TEST(TemResponse, TheWholeDecayAddsUpToThePerfectConductorsField) {
  const ConductiveSphere sphere{.distance_m = 40.0, .radius_m = 1.0, .conductivity_spm = 0.6};
  const double tau_s = decay_time(sphere), ratio = 1.02, first_s = 1e-3 * tau_s;
  double sum = 2.0 * first_s * sphere_response(kNoRock, sphere, first_s).axial;  // it begins as t^-1/2
  for (double time_s = first_s; time_s < 15.0 * tau_s; time_s *= ratio) {
    sum += sphere_response(kNoRock, sphere, time_s * std::sqrt(ratio)).axial * time_s * (ratio - 1.0);
  }
  EXPECT_NEAR(sum / (kMu0 * 2.0 / (4.0 * kPi * std::pow(40.0, 6))), 1.0, 5e-3);
}

TemGateLayout usual_window() {
  TemGateLayout window;
  for (double gate_s = 2e-6; gate_s < 3e-4; gate_s *= std::pow(10.0, 0.1)) window.gate_s.push_back(gate_s);
  return window;
}

// Integrating t^-5/2 twice gives F(t) = 4/3 t^-1/2; its differences over ramp T and gate a ... b give the mean.
TEST(TemGates, TheRockThroughRampAndGatesIsItsDoubleIntegralToOneInTenThousand) {
  const TemGateLayout window = usual_window();
  const Eigen::VectorXd rate = gated_whole_space_response(TemGates(window), 0.003);
  for (std::size_t gate = 0; gate < window.gate_s.size(); ++gate) {
    const double a = window.gate_s[gate] * (1.0 - window.gate_width / 2.0),
                 b = window.gate_s[gate] * (1.0 + window.gate_width / 2.0);
    const double T = window.ramp_s;
    const auto F = [](double t) { return 4.0 / 3.0 / std::sqrt(t); };
    const double mean = (F(b + T) - F(a + T) - F(b) + F(a)) / (T * (b - a));
    EXPECT_NEAR(rate[static_cast<Eigen::Index>(gate)] / (whole_space_response(0.003, 1.0) * mean), 1.0, 1e-4)
        << window.gate_s[gate];
  }
}

TEST(TemGates, ASphereThroughRampAndGatesIsTheFineSumToThreePerMille) {
  const TemGateLayout window = usual_window();
  const ConductiveSphere sphere{.distance_m = 16.0, .radius_m = 6.0, .conductivity_spm = 0.6};
  const GatedSphereResponse gated = gated_sphere_response(TemGates(window), 0.003, sphere);
  constexpr int kSteps = 30;
  for (const std::size_t gate : {0UL, 4UL, 8UL}) {
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double time_s = window.gate_s[gate] * (1.0 + window.gate_width * ((i + 0.5) / kSteps - 0.5)) +
                              window.ramp_s * (j + 0.5) / kSteps;
        sum += sphere_response(0.003, sphere, time_s).axial / (kSteps * kSteps);
      }
    }
    EXPECT_NEAR(gated.axial[static_cast<Eigen::Index>(gate)] / sum, 1.0, 3e-3) << window.gate_s[gate];
  }
}

}  // namespace
}  // namespace patrol::tem_response_test
