#include "inspect/lining/surface_cloud.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace patrol::inspect::surface_cloud_test {
namespace {

/// A wall at y = 4 m, 2 m by 2 m, a point every centimetre.
std::vector<ScannerPoint> wall(double noise_std_m = 0.0) {
  const RandomStream noise(3, "test/wall");
  std::vector<ScannerPoint> points;
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 200; ++k) {
      const double y = 4.0 + noise_std_m * noise.normal(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(k));
      points.push_back(
          {static_cast<float>(0.01 * i - 1.0), static_cast<float>(y), static_cast<float>(0.01 * k - 1.0), 50.0F});
    }
  }
  return points;
}

TEST(Thin, WallOf4SquareMetresAt10cmKeepsAbout400PointsAndEveryBeamCounts) {
  int beams = 0;
  const auto thinned = downsample(wall(), 0.1);
  for (const DownsampledPoint& point : thinned) {
    EXPECT_NEAR(point.p.y(), 4.0, 1e-6);
    EXPECT_EQ(point.intensity, 50.0);
    beams += point.count;
  }
  EXPECT_EQ(beams, 40000);
  EXPECT_GT(thinned.size(), 300U);  // cells are between 0.7 and 1.4 spacings wide
  EXPECT_LT(thinned.size(), 1000U);
}

TEST(Thin, MeansAreNotBiasedByNoiseWhereverTheWallStands) {
  // Cells in space would sort a wall's points by their noise. The mean of means has a standard deviation of 0.002 /
  // sqrt(40000) = 0.01 mm, somewhat more as cells differ in size.
  double sum = 0.0;
  const auto thinned = downsample(wall(0.002), 0.1);
  for (const DownsampledPoint& point : thinned) sum += point.p.y() - 4.0;
  EXPECT_LT(std::abs(sum / static_cast<double>(thinned.size())), 5e-5);
}

TEST(Thin, StepInRangeIsNotAveragedOver) {
  // One direction, two surfaces.
  const auto thinned = downsample({{2.0F, 0.0F, 0.0F, 0.0F}, {2.01F, 0.0F, 0.0F, 0.0F}, {2.5F, 0.0F, 0.0F, 0.0F}}, 0.1);
  ASSERT_EQ(thinned.size(), 2U);
  EXPECT_NEAR(thinned[0].p.x(), 2.005, 1e-6);
  EXPECT_NEAR(thinned[1].p.x(), 2.5, 1e-6);
}

TEST(Thin, WhatIsNearerThan1500mmIsLeftOut) {
  EXPECT_TRUE(downsample({{1.4F, 0.0F, 0.3F, 0.0F}}, 0.1, 1.5).empty());
  EXPECT_EQ(downsample({{1.6F, 0.0F, 0.0F, 0.0F}}, 0.1, 1.5).size(), 1U);
}

TEST(Thin, PointThatIsNotFiniteIsRefused) {
  EXPECT_THROW(downsample({{1.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F}}, 0.1), InputError);
  EXPECT_THROW(downsample({{std::numeric_limits<float>::infinity(), 0.0F, 0.0F, 0.0F}}, 0.1), InputError);
}

TEST(SurfaceCloud, NormalsOfAWallLieAcrossIt) {
  const SurfaceCloud cloud(downsample(wall(), 0.1));
  for (const SurfaceCloud::Surface& surface : cloud.surfaces()) EXPECT_NEAR(std::abs(surface.normal.y()), 1.0, 1e-5);
}

TEST(SurfaceCloud, RowOfPointsIsNoSurface) {
  std::vector<DownsampledPoint> row;
  for (int i = 0; i < 20; ++i) row.push_back({.p = {0.1 * i, 0.0, 0.0}, .intensity = 0.0, .count = 1});
  const SurfaceCloud cloud(row);
  for (const SurfaceCloud::Surface& surface : cloud.surfaces()) EXPECT_TRUE(surface.normal.isZero());
}

TEST(SurfaceCloud, OfNothingNothingIsNearest) { EXPECT_EQ(SurfaceCloud({}).nearest({0.0, 0.0, 0.0}, 1).count, 0U); }

}  // namespace
}  // namespace patrol::inspect::surface_cloud_test
