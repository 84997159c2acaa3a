#include "inspect/lining/robust_mean.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::inspect::robust_mean_test {
namespace {

TEST(RobustMean, SpreadOfANormalDistributionIsItsStandardDeviation) {
  const RandomStream noise(1, "test/spread");
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 10000; ++i) values.push_back(3.0 + 0.5 * noise.normal(i));
  EXPECT_NEAR(mad_std(values, median_of(values)), 0.5,
              0.5 * 4.0 * 1.17 / std::sqrt(10000.0));  // its own: 1.17 / sqrt(n)
}

TEST(RobustMean, TenthThatLies30mmOffDoesNotPull) {
  const RandomStream noise(2, "test/mean");
  std::vector<double> values;
  for (std::uint64_t i = 0; i < 900; ++i) values.push_back(0.001 * noise.normal(i));
  values.insert(values.end(), 100, 0.03);
  const RobustMean mean = robust_mean(values, std::vector<double>(1000, 1.0), 0.003);
  EXPECT_LT(std::abs(mean.mean), 4.0 * 0.001 / 30.0);
  EXPECT_NEAR(std::sqrt(mean.var), 0.001 / 30.0, 0.2 * 0.001 / 30.0);
  EXPECT_LE(mean.kept, 900);
}

TEST(RobustMean, WeightsCount) {
  // (0 * 3 + 4 * 1) / 4, within a reach that makes the biweight all but flat.
  EXPECT_NEAR(robust_mean({0.0, 4.0}, {3.0, 1.0}, 1e5).mean, 1.0, 1e-6);
}

TEST(RobustMean, OfNothingIsNothing) {
  const RobustMean mean = robust_mean({}, {}, 1.0);
  EXPECT_EQ(mean.kept, 0);
  EXPECT_EQ(mean.mean, 0.0);
}

}  // namespace
}  // namespace patrol::inspect::robust_mean_test
