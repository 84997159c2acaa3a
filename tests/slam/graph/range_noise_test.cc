#include "slam/graph/range_noise.h"

#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::slam::range_noise_test {
namespace {

/// Scans of a square room of 10 m from its center, with normal noise; every tenth beam has no return.
RangeNoiseEstimator estimator_of(double std_m, int num_beams, int num_scans) {
  const RandomStream noise(3, "test/range_noise");
  RangeNoiseEstimator estimator;
  std::uint64_t draw = 0;
  for (int s = 0; s < num_scans; ++s) {
    LaserScan scan;
    scan.angle_min_rad = -M_PI;
    scan.angle_increment_rad = 2.0 * M_PI / num_beams;
    for (int beam = 0; beam < num_beams; ++beam) {
      const double angle = scan.angle_min_rad + beam * scan.angle_increment_rad;
      const double range = 5.0 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
      scan.ranges_m.push_back(beam % 10 == 0 ? std::numeric_limits<float>::infinity()
                                             : static_cast<float>(range + std_m * noise.normal(draw++)));
    }
    estimator.add(scan);
  }
  return estimator;
}

TEST(RangeNoise, IsEstimatedToFivePercentOfAHundredScans) {
  for (const double std_m : {0.01, 0.05, 0.1, 0.3}) {
    const auto found = estimator_of(std_m, 360, 100).std_m();
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, std_m, 0.05 * std_m) << std_m;
  }
}

TEST(RangeNoise, OfFewOrDistantBeamsIsNotEstimated) {
  EXPECT_FALSE(estimator_of(0.1, 360, 3).std_m());
  EXPECT_FALSE(estimator_of(0.1, 60, 1000).std_m());  // 0.5 m apart
}

TEST(RangeNoise, UpToFourCentimetersLeavesTheSettings) {
  ScanTrackerSettings settings;
  EXPECT_FALSE(adapt_to_range_noise(0.04, settings));
  const ScanTrackerSettings usual;
  EXPECT_EQ(settings.matching.surface_radius_cells, usual.matching.surface_radius_cells);
  EXPECT_EQ(settings.integration.free_margin_m, usual.integration.free_margin_m);
  EXPECT_EQ(settings.keyframe_distance_m, usual.keyframe_distance_m);
  EXPECT_EQ(settings.submap_keyframes, usual.submap_keyframes);
  EXPECT_FALSE(settings.groups_scans);
}

// Smoothed ranges have 0.6 of the noise.
TEST(RangeNoise, WidensNeighborhoodKernelAndMarginUpToTheLimitOfTheRadius) {
  ScanTrackerSettings settings;
  EXPECT_TRUE(adapt_to_range_noise(0.2, settings));
  EXPECT_EQ(settings.matching.surface_radius_cells, 7);
  EXPECT_NEAR(settings.matching.kernel_m, 0.3, 1e-12);
  EXPECT_NEAR(settings.matching.point_std_m, 0.06, 1e-12);
  EXPECT_NEAR(settings.integration.free_margin_m, 0.42, 1e-12);
  EXPECT_TRUE(adapt_to_range_noise(0.05, settings));  // larger settings remain
  EXPECT_EQ(settings.matching.surface_radius_cells, 7);
  EXPECT_TRUE(adapt_to_range_noise(1.0, settings));
  EXPECT_EQ(settings.matching.surface_radius_cells, 10);
}

TEST(RangeNoise, KeyframesAreCloserByUpToFourTenthsAndContainAllScansAndMapsHaveFewerUpTo20Centimeters) {
  const ScanTrackerSettings usual;
  ASSERT_EQ(usual.submap_keyframes, 60);
  for (const auto& [std_m, step, submap_keyframes] :
       {std::tuple{0.05, 0.8, 30}, {0.1, 0.4, 30}, {0.15, 0.4, 45}, {0.3, 0.4, 60}}) {
    ScanTrackerSettings settings;
    EXPECT_TRUE(adapt_to_range_noise(std_m, settings));
    EXPECT_NEAR(settings.keyframe_distance_m, step * usual.keyframe_distance_m, 1e-12) << std_m;
    EXPECT_NEAR(settings.keyframe_angle_rad, step * usual.keyframe_angle_rad, 1e-12) << std_m;
    EXPECT_EQ(settings.submap_keyframes, submap_keyframes) << std_m;
    EXPECT_TRUE(settings.groups_scans);
  }
  ScanTrackerSettings closer;
  closer.keyframe_distance_m = 0.01;
  closer.submap_keyframes = 10;
  EXPECT_TRUE(adapt_to_range_noise(0.1, closer));
  EXPECT_EQ(closer.keyframe_distance_m, 0.01);
  EXPECT_EQ(closer.submap_keyframes, 10);
}

}  // namespace
}  // namespace patrol::slam::range_noise_test
