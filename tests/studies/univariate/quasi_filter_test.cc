#include "studies/univariate/quasi_filter.h"

#include <cmath>
#include <memory>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "studies/univariate/exact_filter.h"
#include "studies/univariate/growth_filter.h"
#include "tests/studies/univariate/growth_runs.h"

namespace patrol::studies::quasi_filter_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// Root mean square distance of a filter's means from the exact ones, over runs.
double distance_from_exact(const FilterMaker& make, std::uint64_t seeds) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const GrowthRun run = GrowthModel().simulate(seed);
    ExactFilter exact((GrowthModel()));
    const double distance = rms_difference(means_of(filter_all(*make(seed, run), run.observations)),
                                           means_of(filter_all(exact, run.observations)));
    sum += distance * distance;
  }
  return std::sqrt(sum / static_cast<double>(seeds));
}

FilterMaker quasi_filters(const QuasiFilterSettings& settings) {
  return [=](std::uint64_t seed, const GrowthRun&) {
    return std::make_unique<QuasiFilter>(settings, GrowthModel(), seed);
  };
}

TEST(QuasiFilter, ComesWithinFiveThousandthsOfTheExactMeansWithTwentyThousandParticles) {
  EXPECT_LT(distance_from_exact(quasi_filters({.particles = 20'000}), 1), 0.005);
  EXPECT_LT(distance_from_exact(quasi_filters({.particles = 20'000, .use_auxiliary = false}), 1), 0.005);
}

TEST(QuasiFilter, WithAHundredAndFiftyParticlesIsFourTimesNearerToTheExactMeansThanRandomSamples) {
  const FilterMaker bootstrap = [](std::uint64_t seed, const GrowthRun&) {
    return std::make_unique<GrowthFilter>(150, GrowthModel(), slam::make_components({.resample_threshold = 1.0}), seed);
  };
  EXPECT_LT(distance_from_exact(quasi_filters({.particles = 150}), 30), 0.25 * distance_from_exact(bootstrap, 30));
}

TEST(QuasiFilter, LooksAheadToNearlyEqualWeights) {
  const GrowthRun run = GrowthModel().simulate(1);
  double ahead = 0.0, behind = 0.0;
  for (const bool use_auxiliary : {true, false}) {
    QuasiFilter filter({.particles = 100, .use_auxiliary = use_auxiliary}, GrowthModel(), 1);
    for (const UnivariateEstimate& estimate : filter_all(filter, run.observations))
      (use_auxiliary ? ahead : behind) += estimate.effective_sample_size / 100.0;
  }
  EXPECT_GT(ahead, 90.0);  // of 100
  EXPECT_LT(behind, 70.0);
}

// Over the shifts every point is even in the square, so that a single particle's first state is N(8, 1).
TEST(QuasiFilter, SamplesASingleParticleFromNormalEightOne) {
  double sum = 0.0, squares = 0.0;
  constexpr int kSeeds = 20'000;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const double drawn = QuasiFilter({.particles = 1, .use_auxiliary = false}, GrowthModel(), seed).step(0.0).mean;
    sum += drawn, squares += drawn * drawn;
  }
  const double mean = sum / kSeeds, variance = squares / kSeeds - mean * mean;
  EXPECT_NEAR(mean, 8.0, 4.0 / std::sqrt(kSeeds));
  EXPECT_NEAR(variance, 1.0, 4.0 * std::sqrt(2.0 / kSeeds));
}

TEST(QuasiFilter, ShowsParticlesAndWeightsOfItsEstimate) {
  QuasiFilter filter({.particles = 37}, GrowthModel(), 1);
  for (const double observation : GrowthModel().simulate(1).observations) {
    const UnivariateEstimate estimate = filter.step(observation);
    ASSERT_EQ(filter.states().size(), 37U);
    EXPECT_NEAR(std::accumulate(filter.weights().begin(), filter.weights().end(), 0.0), 1.0, 1e-12);
    EXPECT_EQ(summarize(filter.states(), filter.weights()).mean, estimate.mean);
  }
}

TEST(QuasiFilter, GivesTheSameForTheSameSeedOnly) {
  const GrowthRun run = GrowthModel().simulate(1);
  EXPECT_EQ(means_of(filter_all(*quasi_filters({})(3, run), run.observations)),
            means_of(filter_all(*quasi_filters({})(3, run), run.observations)));
  EXPECT_NE(means_of(filter_all(*quasi_filters({})(3, run), run.observations)),
            means_of(filter_all(*quasi_filters({})(4, run), run.observations)));
}

TEST(QuasiFilter, StaysFiniteWhereTheModelExplodes) {
  const GrowthModel model({.denominator_sign = -1});
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    QuasiFilter filter({.particles = 50}, model, seed);
    for (const UnivariateEstimate& estimate : filter_all(filter, model.simulate(seed).observations))
      EXPECT_TRUE(std::isfinite(estimate.mean));
  }
}

TEST(QuasiFilter, NamesTheSettingThatBreaksItsRule) {
  EXPECT_THAT([] { QuasiFilter({.particles = 0}, GrowthModel(), 1); },
              ThrowsMessage<InputError>(HasSubstr("quasi_filter.particles")));
  EXPECT_THAT([] { QuasiFilter({.proposal_inflation = 0.5}, GrowthModel(), 1); },
              ThrowsMessage<InputError>(HasSubstr("quasi_filter.proposal_inflation")));
}

}  // namespace
}  // namespace patrol::studies::quasi_filter_test
