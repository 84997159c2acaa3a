#include "core/particle_weights.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::particle_weights_test {
namespace {

constexpr double kExactTol = 1e-12;

std::vector<double> random_weights(std::uint64_t seed, std::size_t count) {
  const RandomStream stream(seed, "test/weights");
  std::vector<double> logs;
  for (std::size_t i = 0; i < count; ++i) logs.push_back(3.0 * stream.normal(i));
  return normalized_weights(logs);
}

std::vector<int> children_of(const std::vector<double>& weights, double uniform) {
  std::vector<int> children(weights.size());
  for (const std::size_t parent : systematic_parents(weights, uniform)) ++children[parent];
  return children;
}

TEST(NormalizedWeights, KeepRatiosAndSumToOne) {
  const std::vector<double> weights = normalized_weights({std::log(1.0), std::log(3.0), std::log(4.0)});
  EXPECT_NEAR(weights[0], 0.125, kExactTol);
  EXPECT_NEAR(weights[1], 0.375, kExactTol);
  EXPECT_NEAR(weights[2], 0.5, kExactTol);
}

TEST(NormalizedWeights, SurviveLogarithmsOfMinusTenThousand) {
  const std::vector<double> weights = normalized_weights({-10'000.0, -10'000.0 + std::log(3.0)});
  EXPECT_NEAR(weights[0], 0.25, 1e-9);
  EXPECT_TRUE(normalized_weights({}).empty());
}

TEST(EffectiveSampleSize, IsNForEqualWeightsAndOneForASingleHeavyOne) {
  EXPECT_NEAR(effective_sample_size({0.25, 0.25, 0.25, 0.25}), 4.0, kExactTol);
  EXPECT_NEAR(effective_sample_size({0.0, 1.0, 0.0}), 1.0, kExactTol);
  EXPECT_NEAR(effective_sample_size({0.5, 0.5, 0.0, 0.0}), 2.0, kExactTol);
}

TEST(ResampleSystematic, GivesFloorOrCeilOfNWChildren) {
  for (const std::size_t count : {1U, 2U, 7U, 30U}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const std::vector<double> weights = random_weights(seed, count);
      for (const double uniform : {1e-9, 0.25, 0.5, 0.9, 1.0 - 1e-9}) {
        const std::vector<int> children = children_of(weights, uniform);
        EXPECT_EQ(std::accumulate(children.begin(), children.end(), 0), static_cast<int>(count));
        for (std::size_t i = 0; i < count; ++i) {
          const double expected = static_cast<double>(count) * weights[i];
          EXPECT_GE(children[i], std::floor(expected - 1e-9));
          EXPECT_LE(children[i], std::ceil(expected + 1e-9));
        }
      }
    }
  }
}

// The mean number of children over all draws is N w: here over 1000 draws evenly spread in (0, 1), each
// parent's count changes twice at most, so the mean is right to 2/1000.
TEST(ResampleSystematic, IsUnbiasedToTwoInAThousand) {
  const std::vector<double> weights = random_weights(3, 8);
  std::vector<double> mean(weights.size());
  for (int k = 0; k < 1000; ++k) {
    const std::vector<int> children = children_of(weights, (k + 0.5) / 1000.0);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += children[i] / 1000.0;
  }
  for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_NEAR(mean[i], 8.0 * weights[i], 0.002) << i;
}

TEST(ResampleSystematic, EqualWeightsKeepEveryoneInOrder) {
  EXPECT_EQ(systematic_parents(std::vector<double>(5, 0.2), 0.5), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(ResampleSystematic, AWeightOfZeroHasNoChildren) {
  for (const double uniform : {1e-12, 0.5, 1.0 - 1e-12}) {
    EXPECT_EQ(children_of({0.0, 0.5, 0.0, 0.5, 0.0}, uniform)[0], 0);
    EXPECT_EQ(children_of({0.0, 0.5, 0.0, 0.5, 0.0}, uniform)[2], 0);
    EXPECT_EQ(children_of({0.0, 0.5, 0.0, 0.5, 0.0}, uniform)[4], 0);
  }
}

}  // namespace
}  // namespace patrol::particle_weights_test
