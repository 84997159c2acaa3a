#include "inspect/lining/ring_findings.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/lined_tunnel.h"

namespace patrol::inspect::ring_findings_test {
namespace {

const LiningInMap kLining{.design = test::LinedTunnel().lining, .invert_m = -0.3};
const LiningGrid kGrid(kLining, {35.0, 0.0, 0.5}, {});

/// What is measured in ring 18, by the clock, to 0.2 mm; all other rings are still; the registration is perfect but for
/// `along_j`.
Adjustment ring_18(const std::function<double(double clock_deg)>& inward_m, double std_m = 2e-4) {
  Adjustment adjustment;
  adjustment.covariance = Matrix7::Zero();
  for (int cell = 0; cell < kGrid.cells(); ++cell) {
    Patch patch;
    patch.cell = cell;
    patch.points = 100;
    patch.var_m2 = std_m * std_m;
    patch.J[2] = 1.0;
    if (kGrid.ring_of(cell) == 18) patch.offset_m = inward_m(kGrid.clock_deg(kGrid.sector_of(cell)));
    adjustment.patches.push_back(patch);
  }
  return adjustment;
}

double line(const std::vector<ConvergenceLine>& lines, const std::string& name) {
  for (const ConvergenceLine& found : lines) {
    if (found.ring == 18 && found.name == name) return found.change_m;
  }
  ADD_FAILURE() << name << " is missing";
  return 0.0;
}

TEST(RingFindings, Bulge12mmHighKeepsItsHeightAndItsPlace) {
  const auto bulge = [](double clock_deg) {
    return std::abs(clock_deg - 40.0) < 40.0
               ? 0.012 * std::pow(std::cos(std::numbers::pi * (clock_deg - 40.0) / 80.0), 2)
               : 0.0;
  };
  const auto findings = ring_findings(kLining, kGrid, ring_18(bulge), {});
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].ring, 18);
  EXPECT_EQ(findings[0].clock_deg, 40.0);
  // (-3 * 6 + 12 * 10.24 + 17 * 12 + 12 * 10.24 - 3 * 6) / 35 = 11.82 mm
  EXPECT_NEAR(findings[0].inward_m, 0.01182, 1e-5);
  EXPECT_EQ(findings[0].level, WarningLevel::kAlarm);
  EXPECT_TRUE(findings[0].p_map.isApprox(kLining.intrados(35.0, 40.0), 1e-9));
  // sqrt(2 * 9 + 2 * 144 + 289) / 35 = 0.70 of a cell's.
  EXPECT_NEAR(findings[0].std_m, 0.697 * 2e-4, 1e-6);
}

TEST(RingFindings, ThresholdsOf2And5And10mmMakeTheLevels) {
  const auto level = [](double inward_m) {
    const auto findings = ring_findings(kLining, kGrid, ring_18([=](double) { return inward_m; }), {});
    return findings.empty() ? WarningLevel::kNone : findings[0].level;
  };
  EXPECT_EQ(level(0.0019), WarningLevel::kNone);
  EXPECT_EQ(level(0.0021), WarningLevel::kNotice);
  EXPECT_EQ(level(0.0051), WarningLevel::kWarning);
  EXPECT_EQ(level(0.0101), WarningLevel::kAlarm);
  EXPECT_EQ(level(-0.0051), WarningLevel::kWarning);  // outwards matters as much
}

TEST(RingFindings, ThreeMillimetresKnownToOneAreNoFinding) {
  EXPECT_TRUE(ring_findings(kLining, kGrid, ring_18([](double) { return 0.003; }, 0.001), {}).empty());
}

// 13.4 arc seconds in two scans, 8 m along the tunnel: 0.74 mm, which smoothing does not reduce. Cells have 0.2 mm.
TEST(RingFindings, AngleErrorsOfTheScansGrowWithTheDistanceAlongTheTunnel) {
  const auto std_at = [](double arm_m) {
    Adjustment adjustment = ring_18([](double) { return 0.0060; });
    const double angle_std_rad = 13.4 / 3600.0 * kDegree;
    adjustment.angle_var_rad2 = 2.0 * angle_std_rad * angle_std_rad;
    for (Patch& patch : adjustment.patches) patch.J[3] = arm_m;
    const auto findings = ring_findings(kLining, kGrid, adjustment, {});
    return findings.empty() ? 0.0 : findings[0].std_m;
  };
  EXPECT_NEAR(std_at(0.0), 2e-4, 1e-6);  // the first sector is not smoothed
  EXPECT_NEAR(std_at(8.0), std::hypot(2e-4, 0.735e-3), 2e-6);
  EXPECT_EQ(std_at(16.0), 0.0);  // 6 mm are less than 4.5 standard deviations
}

TEST(RingFindings, WhatTheRegistrationLeavesOpenCountsToo) {
  Adjustment adjustment = ring_18([](double) { return 0.003; });
  adjustment.covariance(2, 2) = 0.001 * 0.001;
  EXPECT_TRUE(ring_findings(kLining, kGrid, adjustment, {}).empty());
  for (const LiningCell& cell : lining_cells(kGrid, adjustment))
    EXPECT_NEAR(cell.std_m, std::hypot(0.0002, 0.001), 1e-9);
}

TEST(ConvergenceLines, RingPushedInwardsBy6mmAllRoundShortensTheSpringlineBy12AndLowersTheCrownBy6) {
  const auto lines = convergence_lines(kLining, kGrid, ring_18([](double) { return 0.006; }));
  EXPECT_NEAR(line(lines, "9-3"), -0.012, 1e-9);
  EXPECT_NEAR(line(lines, "10-2"), -0.012 * std::sin(std::numbers::pi / 3.0), 1e-9);
  // From the crown down to the springline the chord is at 45 degrees to both radii.
  EXPECT_NEAR(line(lines, "12-9"), -0.012 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(line(lines, "12-3"), -0.012 * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(line(lines, "12-"), -0.006, 1e-9);
}

TEST(ConvergenceLines, CommonErrorOfTheRegistrationHardlyTouchesAChord) {
  // Both ends shift alike: what one gains the other loses.
  Adjustment adjustment = ring_18([](double) { return 0.0; });
  for (Patch& patch : adjustment.patches) {
    const double clock = to_rad(kGrid.clock_deg(kGrid.sector_of(patch.cell)));
    patch.J = Vector7::Zero();
    patch.J[1] = std::sin(clock);
  }
  adjustment.covariance(1, 1) = 0.01 * 0.01;
  for (const ConvergenceLine& found : convergence_lines(kLining, kGrid, adjustment)) {
    if (found.name == "9-3") {
      EXPECT_LT(found.std_m, 4e-4);
    }
  }
}

TEST(ConvergenceLines, LineWithoutItsMarkIsLeftOut) {
  Adjustment adjustment = ring_18([](double) { return 0.0; });
  std::erase_if(adjustment.patches,
                [](const Patch& patch) { return kGrid.clock_deg(kGrid.sector_of(patch.cell)) == 270.0; });
  for (const ConvergenceLine& found : convergence_lines(kLining, kGrid, adjustment)) {
    EXPECT_NE(found.name, "9-3");
    EXPECT_NE(found.name, "12-9");
  }
}

}  // namespace
}  // namespace patrol::inspect::ring_findings_test
