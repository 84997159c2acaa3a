#include "inspect/lining/reference_lining.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/lined_tunnel.h"

namespace patrol::inspect::reference_lining_test {
namespace {

const LiningInMap kLining{.design = test::LinedTunnel().lining, .invert_m = 0.0};
const LiningGrid kGrid(kLining, {35.0, 0.0, 0.85}, {});

/// Ring 18 about the crown, every 8 cm, built 10 mm too far in at its beginning and leaning outwards by 5 mm/m.
double as_built_m(double chainage_m) { return 0.010 - 0.005 * (chainage_m - 34.0); }

std::vector<DownsampledPoint> ring_18(double noise_std_m) {
  const RandomStream noise(7, "test/ring");
  std::vector<DownsampledPoint> points;
  for (int i = 0; i < 25; ++i) {
    for (int k = -25; k <= 25; ++k) {
      const double s = 34.0 + 0.08 * i, clock_deg = std::fmod(360.0 + 0.8 * k, 360.0);
      const Eigen::Vector3d p = kLining.intrados(s, clock_deg);
      const double inward_m = as_built_m(s) + noise_std_m * noise.normal(static_cast<std::uint64_t>(i),
                                                                         static_cast<std::uint64_t>(k + 100));
      points.push_back({.p = p + inward_m * lining_point(kLining, p).gradient, .intensity = 0.0, .count = 1});
    }
  }
  return points;
}

TEST(ReferenceLining, LeaningRingIsFollowedToATenthOfAMillimetre) {
  const ReferenceLining reference(kLining, kGrid, ring_18(0.0), {});
  for (const double s : {34.3, 35.03, 35.6}) {
    const LiningPoint point{.chainage_m = s, .clock_deg = 2.0};
    const auto inward_m = reference.inward_m(point, kGrid.cell_at(point));
    ASSERT_TRUE(inward_m.has_value());
    EXPECT_NEAR(*inward_m, as_built_m(s), 1e-4);
  }
}

TEST(ReferenceLining, CableThatHangs30mmBeforeTheWallIsNotTheLining) {
  std::vector<DownsampledPoint> points = ring_18(0.001);
  for (int i = 0; i < 100; ++i)
    points.push_back(
        {.p = kLining.intrados(34.0 + 0.02 * i, 2.0) - Eigen::Vector3d(0.0, 0.0, 0.03), .intensity = 0.0, .count = 1});
  const ReferenceLining reference(kLining, kGrid, points, {});
  const LiningPoint point{.chainage_m = 35.0, .clock_deg = 2.0};
  EXPECT_NEAR(reference.inward_m(point, kGrid.cell_at(point)).value(), as_built_m(35.0), 0.001);
}

TEST(ReferenceLining, MeanOf200PointsWith2mmOfNoiseHasAStandardDeviationOf140Micrometres) {
  const ReferenceLining reference(kLining, kGrid, ring_18(0.002), {});
  const int cell = kGrid.cell_at({.chainage_m = 35.0, .clock_deg = 0.0});
  const double expected_m = 0.002 / std::sqrt(reference.points(cell));
  EXPECT_GT(reference.points(cell), 200);
  // Planes through few neighbours have noise of their own, which is counted too: never less than the truth, at most
  // half as much again.
  EXPECT_GT(std::sqrt(reference.var_m2(cell)), 0.9 * expected_m);
  EXPECT_LT(std::sqrt(reference.var_m2(cell)), 1.5 * expected_m);
}

TEST(ReferenceLining, WhereNothingWasSeenNothingIsKnown) {
  const ReferenceLining reference(kLining, kGrid, ring_18(0.0), {});
  const LiningPoint point{.chainage_m = 35.0, .clock_deg = 90.0};
  EXPECT_FALSE(reference.inward_m(point, kGrid.cell_at(point)).has_value());
  EXPECT_EQ(reference.points(kGrid.cell_at(point)), 0);
}

}  // namespace
}  // namespace patrol::inspect::reference_lining_test
