#include <cmath>
#include <cstdint>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "realism/hit_fit.h"
#include "realism/range_step.h"
#include "realism/return_fit.h"

namespace patrol::realism {
namespace {

using ::testing::HasSubstr;

std::vector<float> rounded_ranges(double step_m) {
  const RandomStream random(7, "ranges");
  std::vector<float> ranges_m;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    const double range_m = 0.2 + 24.0 * random.uniform(k);
    ranges_m.push_back(static_cast<float>(step_m > 0.0 ? step_m * std::round(range_m / step_m) : range_m));
  }
  return ranges_m;
}

TEST(RangeStep, IsFoundToAMicrometerFromTheRangesAlone) {
  for (const double step_m : {0.0005, 0.001, 0.0137, 0.01, 0.25}) {
    const FittedParameter step = fit_range_step(rounded_ranges(step_m));
    EXPECT_TRUE(step.is_seen) << step_m;
    EXPECT_NEAR(step.value, step_m, 1e-6);
    EXPECT_TRUE(step.contains(step_m)) << step_m;
  }
  const FittedParameter none = fit_range_step(rounded_ranges(0.0));
  EXPECT_FALSE(none.is_seen);
  EXPECT_THAT(none.reason, HasSubstr("no lattice"));
  EXPECT_TRUE(none.contains(0.0));
  EXPECT_THAT(fit_range_step({1.0f, 2.0f}).reason, HasSubstr("too few"));
}

/// Returns on walls at 1 to 11 m under slopes of up to 4 m per radian.
std::vector<HitSample> hit_samples(double noise_m, double angle_rad, double offset_m, double scale, double max_slope) {
  const RandomStream random(11, "hits");
  std::vector<HitSample> samples;
  for (std::uint64_t k = 0; k < 8000; ++k) {
    HitSample sample;
    sample.range_m = 1.0 + 10.0 * random.uniform(k, 0);
    sample.slope_m_per_rad = max_slope * random.uniform(k, 1);
    sample.cosine = sample.range_m / std::hypot(sample.range_m, sample.slope_m_per_rad);
    sample.block = k / 400;
    const double curvature_m = sample.range_m + 2.0 * sample.slope_m_per_rad * sample.slope_m_per_rad / sample.range_m;
    const double angle = angle_rad * random.normal(k, 2);
    sample.residual_m = offset_m + scale * sample.range_m + noise_m * random.normal(k, 3) +
                        sample.slope_m_per_rad * angle + 0.5 * curvature_m * angle * angle;
    samples.push_back(sample);
  }
  return samples;
}

TEST(HitFit, SeparatesRangeNoiseAngleNoiseOffsetAndScale) {
  const double angle_rad = 0.2 * kDegree;
  const HitFit fit = fit_hits(hit_samples(0.01, angle_rad, 0.02, -0.001, 4.0), {});
  EXPECT_NEAR(fit.values[kNoise_m], 0.01, 0.0004);
  EXPECT_NEAR(fit.values[kAngleNoise_rad], angle_rad, 0.1 * angle_rad);
  EXPECT_NEAR(fit.values[kScale], -0.001, 0.0003);
  EXPECT_LE(fit.low[kOffset_m], 0.02);
  EXPECT_GE(fit.high[kOffset_m], 0.02);
  EXPECT_LT(fit.high[kOffset_m] - fit.low[kOffset_m], 0.004);
  EXPECT_GT(fit.low[kAngleNoise_rad], 0.0);
  EXPECT_FALSE(fit.is_free[kReflectivity_m]);  // one reflectivity
}

TEST(HitFit, AngleNoiseOnWallsSeenHeadOnIsNotFitted) {
  const HitFit fit = fit_hits(hit_samples(0.01, 0.2 * kDegree, 0.0, 0.0, 0.02), {});
  EXPECT_FALSE(fit.is_free[kAngleNoise_rad]);
}

TEST(HitFit, NoiseBelowTheQuantizationStepIsResolved) {
  std::vector<HitSample> samples = hit_samples(0.006, 0.0, 0.003, 0.0, 0.0);
  for (HitSample& sample : samples) {
    const double recorded_m = 0.02 * std::round((sample.range_m + sample.residual_m) / 0.02);
    sample.residual_m = recorded_m - sample.range_m;
  }
  const HitFit fit = fit_hits(samples, {.range_step_m = 0.02});
  EXPECT_NEAR(fit.values[kNoise_m], 0.006, 0.0006);  // the residuals have a standard deviation of 8.3 mm
}

// Least squares on ranges that are uniform from 1 to 11 m: variance 100/12 m^2 about 6 m. No return is an outlier, so
// that the outlier ratio is at its lower bound.
TEST(HitFit, WithoutOutliersTheIntervalsOfOffsetAndScaleAreThoseOfLeastSquares) {
  const HitFit fit = fit_hits(hit_samples(0.01, 0.0, 0.02, -0.001, 0.0), {});
  const double variance_m2 = 100.0 / 12.0, of_mean_m = 0.01 / std::sqrt(8000.0);
  const double scale_std = of_mean_m / std::sqrt(variance_m2);
  const double offset_std_m = of_mean_m * std::sqrt(1.0 + 36.0 / variance_m2);
  const auto ratio = [&](HitParameter j, double std) { return (fit.high[j] - fit.low[j]) / (2.0 * 1.96 * std); };
  EXPECT_GT(ratio(kOffset_m, offset_std_m), 0.95);
  EXPECT_LT(ratio(kOffset_m, offset_std_m), 1.25);  // by blocks of scans
  EXPECT_GT(ratio(kScale, scale_std), 0.95);
  EXPECT_LT(ratio(kScale, scale_std), 1.25);
}

TEST(HitFit, AQuarterOfTheReturnsWithFourTimesTheNoiseIsRecoveredWithin10Percent) {
  std::vector<HitSample> samples = hit_samples(0.01, 0.0, 0.003, 0.0, 0.0);
  const RandomStream random(12, "wide");
  for (std::uint64_t k = 0; k < samples.size(); ++k) {
    if (k % 4 == 0) samples[k].residual_m += 0.04 * random.normal(k);
  }
  const HitFit fit = fit_hits(samples, {});
  EXPECT_NEAR(fit.values[kNoise_m], 0.01, 0.0005);
  EXPECT_NEAR(fit.values[kWideNoise_m], 0.04, 0.004);
  EXPECT_NEAR(fit.values[kWideProbability], 0.25, 0.025);
  EXPECT_LE(fit.low[kWideProbability], 0.25);
  EXPECT_GE(fit.high[kWideProbability], 0.25);
  EXPECT_LT(fit.high[kWideProbability] - fit.low[kWideProbability], 0.08);
  EXPECT_LE(fit.low[kWideNoise_m], 0.04);
  EXPECT_GE(fit.high[kWideNoise_m], 0.04);
}

TEST(HitFit, NormalNoiseHasNoAdditionalNoise) {
  EXPECT_FALSE(fit_hits(hit_samples(0.01, 0.0, 0.003, 0.0, 0.0), {}).is_free[kWideProbability]);
}

TEST(ReturnFit, FindsALimitAndNamesItsAbsence) {
  const RandomStream random(5, "returns");
  std::vector<ReturnSample> samples, unlimited;
  for (std::uint64_t k = 0; k < 5000; ++k) {
    const double angle_deg = 88.0 * random.uniform(k, 0);
    const bool is_kept = random.uniform(k, 1) > 0.02;
    samples.push_back({angle_deg, 0.05, is_kept && angle_deg < 71.3, k / 250});
    unlimited.push_back({angle_deg, 0.05, is_kept, k / 250});
  }
  const LimitFit limit = fit_limit(samples, 90.0);
  EXPECT_TRUE(limit.has_upper);
  EXPECT_NEAR(limit.value, 71.3, 0.2);
  EXPECT_LE(limit.low, 71.3);
  EXPECT_GE(limit.high, 71.3);
  EXPECT_LT(limit.high - limit.low, 1.0);
  const LimitFit none = fit_limit(unlimited, 90.0);
  EXPECT_FALSE(none.has_upper);
  EXPECT_EQ(none.high, 90.0);
  EXPECT_GT(none.low, 85.0);
}

TEST(ReturnFit, ASlowLossOfAFewBeamsIsNoLimit) {
  const RandomStream random(6, "returns");
  std::vector<ReturnSample> samples;
  for (std::uint64_t k = 0; k < 5000; ++k) {
    const double angle_deg = 80.0 * random.uniform(k, 0);
    samples.push_back({angle_deg, 0.05, random.uniform(k, 1) > 0.003 * angle_deg, k / 250});  // up to 24 % are lost
  }
  EXPECT_FALSE(fit_limit(samples, 90.0).has_upper);
}

TEST(ReturnFit, DropoutsHaveWilsonsIntervalAndAWiderOneIfBlocksDiffer) {
  std::vector<ReturnSample> even, grouped;
  for (std::size_t k = 0; k < 2000; ++k) {
    even.push_back({0.0, 0.0, k % 20 != 0, k / 100});
    grouped.push_back({0.0, 0.0, k >= 100, k / 100});  // all losses in one block
  }
  const RateFit rate = fit_dropouts(even), clustered = fit_dropouts(grouped);
  EXPECT_DOUBLE_EQ(rate.value, 0.05);
  EXPECT_NEAR(rate.low, 0.0413, 0.0003);  // Wilson's interval of 100 in 2000
  EXPECT_NEAR(rate.high, 0.0604, 0.0003);
  EXPECT_DOUBLE_EQ(clustered.value, 0.05);
  EXPECT_GT(clustered.high - clustered.low, 5.0 * (rate.high - rate.low));
  EXPECT_EQ(fit_dropouts({{0.0, 0.0, true, 0}}).low, 0.0);
}

}  // namespace
}  // namespace patrol::realism
