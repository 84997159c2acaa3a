#include "studies/univariate/univariate_filter.h"

#include <gtest/gtest.h>

namespace patrol::studies::univariate_filter_test {
namespace {

constexpr double kExactTol = 1e-12;

TEST(Summarize, OneQuarterAtOneAndThreeQuartersAtThreeIsTwoAndAHalf) {
  const UnivariateEstimate estimate = summarize({1.0, 3.0}, {0.25, 0.75});
  EXPECT_NEAR(estimate.mean, 2.5, kExactTol);                   // 0.25 * 1 + 0.75 * 3
  EXPECT_NEAR(estimate.variance, 0.75, kExactTol);              // 0.25 * 1.5^2 + 0.75 * 0.5^2
  EXPECT_NEAR(estimate.effective_sample_size, 1.6, kExactTol);  // 1 / (1/16 + 9/16)
}

TEST(Summarize, OneParticleHasNoVariance) {
  const UnivariateEstimate estimate = summarize({-7.0}, {1.0});
  EXPECT_EQ(estimate.mean, -7.0);
  EXPECT_EQ(estimate.variance, 0.0);
  EXPECT_EQ(estimate.effective_sample_size, 1.0);
}

}  // namespace
}  // namespace patrol::studies::univariate_filter_test
