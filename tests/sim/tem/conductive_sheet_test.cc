#include "sim/tem/conductive_sheet.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace patrol::sim::conductive_sheet_test {
namespace {

constexpr double kPi = std::numbers::pi, kMu0 = 4e-7 * kPi;

// Maxwell's receding image: after the switch-off the field is that of a dipole at 2 h + v t, v = 2 / (mu0 S).
TEST(ConductiveSheet, InANonconductiveHostIsAnImageThatRecedes) {
  for (const double conductance_s : {0.01, 0.06, 1.0}) {
    const double speed_mps = 2.0 / (kMu0 * conductance_s);
    for (const double time_s : {2e-6, 1e-5}) {
      const double expected = kMu0 / (2.0 * kPi) * 3.0 * speed_mps / std::pow(18.0 + speed_mps * time_s, 4);
      const AxialTensor<double> rate = sheet_response(1e-10, conductance_s, 9.0, time_s);
      EXPECT_NEAR(rate.along, expected, 1e-3 * expected) << conductance_s << " S, " << time_s << " s";
      EXPECT_NEAR(rate.across, 0.5 * expected, 1e-3 * expected);
    }
  }
}

// A perfect conductor returns the field of an image in the rock: opposite along the normal, equal parallel to the
// sheet.
TEST(ConductiveSheet, OfGreatConductanceReflectsLikeAPerfectConductor) {
  constexpr double kRock_spm = 0.01, kFrequency = 3e4, kDistance_m = 9.0;
  const double x = std::sqrt(kMu0 * kRock_spm * kFrequency) * 2.0 * kDistance_m, cubed = std::pow(2.0 * kDistance_m, 3);
  const double axial = (1.0 + x) * std::exp(-x) / (2.0 * kPi * cubed),
               parallel = -(1.0 + x + x * x) * std::exp(-x) / (4.0 * kPi * cubed);
  const AxialTensor<std::complex<double>> field = sheet_field(kRock_spm, 1e9, kDistance_m, kFrequency);
  EXPECT_NEAR(field.along.real(), -axial, 1e-4 * axial);
  EXPECT_NEAR(field.across.real(), parallel, 1e-4 * std::abs(parallel));
}

TEST(ConductiveSheet, WithoutConductanceOrFarAwayDoesNotRespond) {
  EXPECT_EQ(sheet_response(0.003, 0.0, 9.0, 2e-6).along, 0.0);
  EXPECT_EQ(sheet_response(0.003, 0.0, 9.0, 2e-6).across, 0.0);
  EXPECT_LT(sheet_response(0.003, 0.02, 2000.0, 2e-6).along, 1e-6 * sheet_response(0.003, 0.02, 9.0, 2e-6).along);
}

}  // namespace
}  // namespace patrol::sim::conductive_sheet_test
