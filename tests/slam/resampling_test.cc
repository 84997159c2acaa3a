#include "slam/resampling.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "core/particle_weights.h"

namespace patrol::slam::resampling_test {
namespace {

const std::vector<double> kWeights = {0.06, 0.32, 0.1, 0.2, 0.01, 0.16, 0.03, 0.12};
constexpr int kDraws = 20'000;
/// 99.9 % of chi^2 with 7 degrees of freedom.
constexpr double kChiSquared7 = 24.32;

RandomSequence sequence(std::uint64_t tick) { return {RandomStream(5, "test/resampler"), tick}; }

/// [parent]; a child that is drawn towards another is a child of both, by its share.
std::vector<double> children_of(const std::vector<Offspring>& offspring, std::size_t parents) {
  std::vector<double> children(parents);
  for (const Offspring& child : offspring) {
    children[child.parent] += 1.0 - child.attraction;
    children[child.attractor] += child.attraction;
  }
  return children;
}

/// [parent], over kDraws calls.
std::vector<double> mean_children(const Resampler& resample) {
  std::vector<double> mean(kWeights.size());
  for (int draw = 0; draw < kDraws; ++draw) {
    RandomSequence random = sequence(static_cast<std::uint64_t>(draw));
    const std::vector<double> children = children_of(resample(kWeights, random), kWeights.size());
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += children[i] / kDraws;
  }
  return mean;
}

/// Pearson's statistic of the numbers of children against N w. For a multinomial draw it is chi^2 with N - 1 degrees of
/// freedom; for an unbiased one of less variance it is smaller.
double chi_squared(const Resampler& resample) {
  const std::vector<double> mean = mean_children(resample);
  double sum = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double expected = 8.0 * kWeights[i];
    sum += kDraws * (mean[i] - expected) * (mean[i] - expected) / expected;
  }
  return sum;
}

std::vector<Offspring> stepwise(const std::vector<double>& weights, RandomSequence& random) {
  return resample_stepwise(weights, random);
}

TEST(ResampleMultinomial, MeanOfTwentyThousandSamplesIsNW) {
  EXPECT_LT(chi_squared(resample_multinomial), kChiSquared7);
  EXPECT_GT(chi_squared(resample_multinomial), 0.60);  // 0.1 %: it is drawn, not dealt out
}

TEST(ResampleSystematic, MeanOfTwentyThousandSamplesIsNW) { EXPECT_LT(chi_squared(resample_systematic), kChiSquared7); }

TEST(ResampleResidual, MeanOfTwentyThousandSamplesIsNW) { EXPECT_LT(chi_squared(resample_residual), kChiSquared7); }

// Each unbiased one to four standard errors, parent by parent. Evenly, a parent's number is floor or ceil of N w:
// variance f (1 - f) with f = N w's fraction. By residuals, R = 4 are drawn with probability f / R each: variance f (1
// - f / R).
TEST(ResampleSystematic, EveryParentsMeanIsNWToFourStandardErrors) {
  const std::vector<double> mean = mean_children(resample_systematic);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double expected = 8.0 * kWeights[i], f = expected - std::floor(expected);
    EXPECT_NEAR(mean[i], expected, 4.0 * std::sqrt(f * (1.0 - f) / kDraws)) << i;
  }
}

TEST(ResampleResidual, EveryParentsMeanIsNWToFourStandardErrors) {
  const std::vector<double> mean = mean_children(resample_residual);
  for (std::size_t i = 0; i < mean.size(); ++i) {
    const double expected = 8.0 * kWeights[i], f = expected - std::floor(expected);
    EXPECT_NEAR(mean[i], expected, 4.0 * std::sqrt(f * (1.0 - f / 4.0) / kDraws)) << i;
  }
}

TEST(OptimizeLowWeights, IsBiasedHundredsOfTimesBeyondTheQuantile) {
  EXPECT_GT(chi_squared(optimize_low_weights), 250.0 * kChiSquared7);
}

TEST(ResampleStepwise, IsBiasedHundredsOfTimesBeyondTheQuantile) {
  EXPECT_GT(chi_squared(stepwise), 250.0 * kChiSquared7);
}

// N w = 2.56, 1.6, 1.28, ...: the whole numbers are certain, in every draw.
TEST(ResampleResidual, FloorOfNWChildrenAreCertain) {
  for (std::uint64_t tick = 0; tick < 200; ++tick) {
    RandomSequence random = sequence(tick);
    const std::vector<Offspring> offspring = resample_residual(kWeights, random);
    const std::vector<double> children = children_of(offspring, kWeights.size());
    EXPECT_EQ(offspring.size(), kWeights.size());
    EXPECT_GE(children[1], 2.0);
    EXPECT_GE(children[3], 1.0);
    EXPECT_GE(children[5], 1.0);
  }
}

TEST(Resamplers, GiveAsManyAsThereWereAndNothingToAWeightOfZero) {
  const std::vector<double> weights = {0.0, 0.5, 0.0, 0.3, 0.2};
  for (const Resampler& resample :
       {Resampler(resample_multinomial), Resampler(resample_systematic), Resampler(resample_residual)}) {
    for (std::uint64_t tick = 0; tick < 100; ++tick) {
      RandomSequence random = sequence(tick);
      const std::vector<Offspring> offspring = resample(weights, random);
      EXPECT_EQ(offspring.size(), 5U);
      for (const Offspring& child : offspring) EXPECT_GT(weights[child.parent], 0.0);
    }
  }
}

TEST(Resamplers, GiveASingleParticleItself) {
  for (const Resampler& resample :
       {Resampler(resample_multinomial), Resampler(resample_systematic), Resampler(resample_residual),
        Resampler(optimize_low_weights), Resampler(stepwise)}) {
    RandomSequence random = sequence(0);
    const std::vector<Offspring> offspring = resample({1.0}, random);
    ASSERT_EQ(offspring.size(), 1U);
    EXPECT_EQ(offspring[0].parent, 0U);
    EXPECT_EQ(offspring[0].attraction, 0.0);
    EXPECT_EQ(offspring[0].mutation, 0.0);
  }
}

// Sum of w^2 = 0.197, N_eff = 5.08, so M = 5: weights 0.32, 0.2, 0.16, 0.12, 0.1, which are the particles 1, 3, 5,
// 7, 2.
TEST(OptimizeLowWeights, KeepsTheFiveHeaviestAndMovesTheRestTowardThem) {
  const std::set<std::size_t> heaviest = {1, 3, 5, 7, 2};
  std::set<std::size_t> towards;
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    RandomSequence random = sequence(tick);
    std::set<std::size_t> parents;
    for (const Offspring& child : optimize_low_weights(kWeights, random)) {
      parents.insert(child.parent);
      if (heaviest.contains(child.parent)) {
        EXPECT_EQ(child.attraction, 0.0);
        continue;
      }
      EXPECT_GT(child.attraction, 0.0);
      EXPECT_LT(child.attraction, 1.0);
      EXPECT_TRUE(heaviest.contains(child.attractor)) << child.attractor;
      towards.insert(child.attractor);
    }
    EXPECT_EQ(parents.size(), kWeights.size());
  }
  EXPECT_EQ(towards, heaviest);
}

// Three light ones give half of themselves to five heavy ones: 1 / 2 is left of each, and a heavy one has 1 + 3 / 10.
// Standard error of the latter under sqrt(3 / 5 / kDraws), since a share is under 1.
TEST(OptimizeLowWeights, CountsTheFiveHeaviestAlike) {
  const std::vector<double> mean = mean_children(optimize_low_weights);
  for (const std::size_t heavy : {1U, 3U, 5U, 7U, 2U})
    EXPECT_NEAR(mean[heavy], 1.3, 4.0 * std::sqrt(0.6 / kDraws)) << heavy;
  for (const std::size_t light : {0U, 4U, 6U})
    EXPECT_NEAR(mean[light], 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kDraws)) << light;
}

// "Largest integer below": four equal weights have N_eff = 4, so M = 3.
TEST(OptimizeLowWeights, OfFourEqualWeightsKeepsThree) {
  RandomSequence random = sequence(0);
  const std::vector<Offspring> offspring = optimize_low_weights({0.25, 0.25, 0.25, 0.25}, random);
  EXPECT_EQ(
      std::count_if(offspring.begin(), offspring.end(), [](const Offspring& child) { return child.attraction == 0.0; }),
      3);
}

// With beta = 0.8, from the heaviest on:
//   w       v_i                       1 - beta^i   delta_i
//   0.4     0.2 x 0.4      = 0.08     0.2          0.4
//   0.3     0.064 + 0.06   = 0.124    0.36         0.344444
//   0.1     0.0992 + 0.02  = 0.1192   0.488        0.244262
//   0.1     0.09536 + 0.02 = 0.11536  0.5904       0.195393
//   0.1     0.092288 + ... = 0.112288 0.67232      0.167016
// delta = 0.270223: two survivors, with ceil(1.480) = 2 and ceil(1.110) = 2 children; the fifth is the heaviest,
// shaken.
TEST(ResampleStepwise, HandExampleOfFiveKeepsTwoTwiceAndShakesTheHeaviest) {
  RandomSequence random = sequence(0);
  const double first_normal = RandomSequence(random).normal();
  const std::vector<Offspring> offspring = resample_stepwise({0.1, 0.3, 0.1, 0.4, 0.1}, random);
  ASSERT_EQ(offspring.size(), 5U);
  const std::vector<std::size_t> parents = {3, 3, 1, 1, 3};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(offspring[i].parent, parents[i]) << i;
    EXPECT_EQ(offspring[i].attraction, 0.0) << i;
    EXPECT_EQ(offspring[i].mutation, i < 4 ? 0.0 : 0.01 * first_normal) << i;
  }
}

// Of 0.41, 0.40, 0.10, 0.09:
//   v: 0.082, 0.1456, 0.13648, 0.127184; over 0.2, 0.36, 0.488, 0.5904: 0.41, 0.404444, 0.279672, 0.215420; delta =
//   0.327384.
// Two survivors, ceil(1.252) = 2 and ceil(1.222) = 2: no room is left, nobody is shaken.
TEST(ResampleStepwise, HandExampleOfFourHasNoRoomForMutations) {
  RandomSequence random = sequence(0);
  std::vector<std::size_t> parents;
  for (const Offspring& child : resample_stepwise({0.41, 0.40, 0.10, 0.09}, random)) {
    parents.push_back(child.parent);
    EXPECT_EQ(child.mutation, 0.0);
  }
  EXPECT_EQ(parents, (std::vector<std::size_t>{0, 0, 1, 1}));
}

// beta = 0: delta_i = w_i, so delta is the mean weight 1 / N; the heavy one has ceil(5 x 0.84) = 5 children, and no
// other has room.
TEST(ResampleStepwise, WithoutAveragingDeltaIsOneOverN) {
  RandomSequence random = sequence(0);
  for (const Offspring& child : resample_stepwise({0.04, 0.04, 0.84, 0.04, 0.04}, random, {.averaging = 0.0}))
    EXPECT_EQ(child.parent, 2U);
}

// delta = 1 / N exactly, so that w / delta = 1 whatever the rounding of the averages.
TEST(ResampleStepwise, EqualWeightsKeepEveryone) {
  for (const std::size_t count : {3U, 7U, 10U, 50U, 100U}) {
    RandomSequence random = sequence(0);
    std::vector<double> children =
        children_of(resample_stepwise(std::vector<double>(count, 1.0 / static_cast<double>(count)), random), count);
    EXPECT_EQ(children, std::vector<double>(count, 1.0)) << count;
  }
}

TEST(ResampleStepwise, MutationsHaveTheStandardDeviationOfOnePercent) {
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t tick = 0; tick < kDraws; ++tick) {
    RandomSequence random = sequence(tick);
    const std::vector<Offspring> offspring = resample_stepwise({0.1, 0.3, 0.1, 0.4, 0.1}, random);
    sum += offspring.back().mutation * offspring.back().mutation;
    ++count;
  }
  EXPECT_NEAR(sum / count, 1e-4, 4.0 * 1e-4 * std::sqrt(2.0 / count));
}

}  // namespace
}  // namespace patrol::slam::resampling_test
