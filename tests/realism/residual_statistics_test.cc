#include "realism/residual_statistics.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::realism {
namespace {

TEST(KsDistance, IsTheOneComputedByHand) {
  // Cumulative distributions of {1, 2, 3, 4} and {2.5, 3.5}: largest difference 1/2 at 2, before the first of the
  // second.
  EXPECT_DOUBLE_EQ(ks_distance({4.0, 1.0, 3.0, 2.0}, {3.5, 2.5}), 0.5);
  EXPECT_DOUBLE_EQ(ks_distance({1.0, 2.0}, {1.0, 2.0}), 0.0);
  EXPECT_DOUBLE_EQ(ks_distance({1.0, 1.0, 2.0}, {1.0, 2.0, 2.0}), 1.0 / 3.0);  // ties
  EXPECT_DOUBLE_EQ(ks_distance({1.0, 2.0}, {3.0, 4.0}), 1.0);
  EXPECT_TRUE(std::isnan(ks_distance({}, {1.0})));
}

TEST(Distribution, HasMedianTailAndRobustSpread) {
  const ResidualDistribution d = distribution_of({-0.02, 0.0, 0.01, 0.02, 0.10});
  EXPECT_EQ(d.count, 5u);
  EXPECT_DOUBLE_EQ(d.median_m, 0.01);
  EXPECT_DOUBLE_EQ(d.median_abs_m, 0.02);
  EXPECT_NEAR(d.p95_abs_m, 0.02 + 0.8 * 0.08, 1e-12);
  EXPECT_NEAR(d.spread_m, 1.4826 * 0.01, 1e-12);  // deviations 0.03, 0.01, 0, 0.01, 0.09
  EXPECT_EQ(distribution_of({}).count, 0u);
}

TEST(Bins, CountDropoutsAndResidualsOfSmoothSurfacesOnly) {
  Beam hit;
  hit.expected.range_m = 2.5;
  hit.expected.is_smooth = true;
  hit.recorded_m = 2.51;
  hit.kind = BeamClass::kStatic;
  Beam lost = hit, edge = hit, far = hit;
  lost.kind = BeamClass::kDropout;
  edge.expected.is_smooth = false;
  far.expected.range_m = 9.0;  // beyond the bins
  const auto bins = bins_of(
      {hit, lost, lost, edge, far}, [](const Beam& beam) { return beam.expected.range_m; }, 0.0, 1.0, 4);
  EXPECT_EQ(bins[2].num_expected, 3u);
  EXPECT_EQ(bins[2].num_dropouts, 2u);
  EXPECT_NEAR(bins[2].dropout_rate(), 2.0 / 3.0, 1e-12);
  EXPECT_EQ(bins[2].residual.count, 1u);
  EXPECT_NEAR(bins[2].residual.median_m, 0.01, 1e-12);
  EXPECT_EQ(bins[1].num_expected + bins[3].num_expected, 0u);
}

}  // namespace
}  // namespace patrol::realism
