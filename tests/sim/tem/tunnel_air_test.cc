#include "sim/tem/tunnel_air.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/sensors/tem_response.h"

namespace patrol::sim::tunnel_air_test {
namespace {

constexpr double kMu0 = 4e-7 * std::numbers::pi, kRock_spm = 0.003;

/// Returns mu0 sigma b^2 / t.
double induction(double radius_m, double time_s) { return kMu0 * kRock_spm * radius_m * radius_m / time_s; }

TEST(TunnelAir, ATunnelWithoutWidthOrInNonconductiveRockHasNoEffect) {
  EXPECT_EQ(tunnel_air_response(kRock_spm, 0.0, 2e-6).along, 0.0);
  const double rock = whole_space_response(kRock_spm, 2e-6);
  EXPECT_LT(std::abs(tunnel_air_response(kRock_spm, 0.3, 2e-6).along), 6e-4 * rock);
  EXPECT_LT(std::abs(tunnel_air_response(kRock_spm, 0.3, 2e-6).across), 4e-3 * rock);
  EXPECT_LT(std::abs(field_in_tunnel(1e-12, 5.0, 1e5).along), 1e-12);
  EXPECT_LT(std::abs(field_in_tunnel(1e-12, 5.0, 1e5).across), 1e-12);
}

// The currents that the removed rock would have carried, by reciprocity: -(5/4) mu0 sigma b^2 / t of the rock's
// response for an infinite tunnel, half of that for a coil at its end.
TEST(TunnelAir, AlongTheTunnelLateResponseIsThatOfTheRemovedCurrents) {
  for (const double time_s : {5e-6, 2e-5}) {
    const double change = tunnel_air_response(kRock_spm, 2.0, time_s).along / whole_space_response(kRock_spm, time_s);
    EXPECT_NEAR(change / induction(2.0, time_s), -1.25, 0.02) << time_s;
  }
}

// Charges on the wall double the field in the removed rock; along an infinite line its effect falls as z^-2 only, up to
// the diffusion depth. This adds -(5/4) mu0 sigma b^2 / t of the rock's response per e-fold of t,
// a limit that is approached slowly: -1.39 here.
TEST(TunnelAir, AcrossTheTunnelItGrowsWithTheLogarithmOfTheDiffusionDepth) {
  const auto relative = [](double time_s) {
    return tunnel_air_response(kRock_spm, 1.0, time_s).across / whole_space_response(kRock_spm, time_s) /
           induction(1.0, time_s);
  };
  EXPECT_NEAR((relative(2e-5) - relative(4e-6)) / std::log(5.0), -1.25, 0.2);
}

TEST(TunnelAir, ATunnelOfFiveMetersWeakensTheFirstGateBySixPercentAlongAndTwentyAcross) {
  const AxialTensor<double> change = tunnel_air_response(kRock_spm, 5.0, 2e-6);
  const double rock = whole_space_response(kRock_spm, 2e-6);
  EXPECT_NEAR(change.along / rock, -0.059, 0.003);
  EXPECT_NEAR(change.across / rock, -0.202, 0.01);
}

}  // namespace
}  // namespace patrol::sim::tunnel_air_test
