#include "importer/site/points/intensity_scale.h"

#include <gtest/gtest.h>

namespace patrol::importer::intensity_scale_test {
namespace {

/// Scale of 1,000 points whose intensities rise evenly from `smallest` to `largest`, with one of `outlier`.
IntensityScale scale_of_even(float smallest, float largest, float outlier) {
  std::vector<ScannerPoint> points = {{0.0f, 0.0f, 0.0f, outlier}};
  for (int i = 0; i < 1000; ++i)
    points.push_back({0.0f, 0.0f, 0.0f, smallest + static_cast<float>(i) / 999.0f * (largest - smallest)});
  return scale_of_cloud(points);
}

TEST(IntensityScale, TheFullScaleIsThatOfTheLargestValue) {
  EXPECT_FLOAT_EQ(scale_of_even(0.0f, 1.0f, 0.5f).light_of(0.6f), 0.6f);
  EXPECT_FLOAT_EQ(scale_of_even(0.0f, 200.0f, 255.0f).light_of(51.0f), 0.2f);
  EXPECT_FLOAT_EQ(scale_of_even(0.0f, 60'000.0f, 0.0f).light_of(6553.5f), 0.1f);
  EXPECT_EQ(scale_of_even(0.0f, 200.0f, 255.0f).rule, "an intensity of 255 is that of a white surface");
}

TEST(IntensityScale, WithNearlyAllPointsInTheLowerHalfTheBrightestOfThemAreWhite) {
  const IntensityScale of_11_bits = scale_of_even(0.0f, 1998.0f, 0.0f),
                       with_target = scale_of_even(0.0f, 999.0f, 65'535.0f);
  EXPECT_NEAR(of_11_bits.light_of(1000.0f), 1000.0 / (0.99 * 1998.0), 1e-3);
  EXPECT_NEAR(with_target.light_of(500.0f), 500.0 / (0.99 * 999.0), 1e-3);
  EXPECT_EQ(with_target.light_of(65'535.0f), 1.0f);
  EXPECT_EQ(with_target.rule,
            "an intensity of 990, which 99 % of the points do not exceed, is that of a white surface");
}

TEST(IntensityScale, WithNegativeIntensitiesTheSmallestOneIsBlack) {
  const IntensityScale scale = scale_of_even(-2048.0f, 2047.0f, 0.0f);
  EXPECT_EQ(scale.light_of(-2048.0f), 0.0f);
  EXPECT_NEAR(scale.light_of(0.0f), 0.5, 0.01);
  EXPECT_TRUE(scale.rule.ends_with(", -2048 that of a black one")) << scale.rule;
}

TEST(IntensityScale, EqualIntensitiesAreUnknownUnlessTheyArePositive) {
  EXPECT_FALSE(scale_of_cloud({}).is_known());
  EXPECT_FALSE(scale_of_even(0.0f, 0.0f, 0.0f).is_known());
  EXPECT_FALSE(scale_of_even(-5.0f, -5.0f, -5.0f).is_known());
  EXPECT_FLOAT_EQ(scale_of_even(51.0f, 51.0f, 51.0f).light_of(51.0f), 1.0f) << "in the lower half of 255";
}

}  // namespace
}  // namespace patrol::importer::intensity_scale_test
