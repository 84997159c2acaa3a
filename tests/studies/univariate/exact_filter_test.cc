#include "studies/univariate/exact_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/studies/univariate/growth_runs.h"

namespace patrol::studies::exact_filter_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kGridTol = 1e-5;  // the trapezoidal rule at a cell of 0.05 (exact_filter.h), of states of size 10

double bell(double offset) { return std::exp(-0.5 * offset * offset); }

// The Bayes filter of two steps, slow and obvious: a double sum in steps of 0.01 over x(1) in 0 ... 16 and x(2) in -30
// ... 30.
double mean_after_two_steps(double first_observation, double second_observation) {
  const GrowthModel model;
  double total = 0.0, sum = 0.0;
  for (int i = 0; i <= 1600; ++i) {
    const double x1 = 0.01 * i, first = bell(x1 - 8.0) * bell(first_observation - x1 * x1 / 20.0);
    if (first < 1e-14) continue;
    for (int j = -3000; j <= 3000; ++j) {
      const double x2 = 0.01 * j,
                   second = first * bell(x2 - model.transition(x1, 2)) * bell(second_observation - x2 * x2 / 20.0);
      total += second, sum += second * x2;
    }
  }
  return sum / total;
}

TEST(ExactFilter, AgreesWithADoubleSumAfterTwoSteps) {
  ExactFilter filter((GrowthModel()));
  filter.step(2.0);
  EXPECT_NEAR(filter.step(4.0).mean, mean_after_two_steps(2.0, 4.0), kGridTol);
}

TEST(ExactFilter, HalvingTheCellMovesNoMeanByAHundredThousandth) {
  const GrowthModel model;
  double greatest = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const GrowthRun run = model.simulate(seed);
    ExactFilter usual(model), fine(model, {.cell = 0.025});
    const std::vector<UnivariateEstimate> a = filter_all(usual, run.observations),
                                          b = filter_all(fine, run.observations);
    for (std::size_t i = 0; i < a.size(); ++i) greatest = std::max(greatest, std::abs(a[i].mean - b[i].mean));
  }
  EXPECT_LT(greatest, kGridTol);
}

TEST(ExactFilter, ACellOfThreeTenthsIsTooCoarse) {
  const GrowthRun run = GrowthModel().simulate(1);
  ExactFilter usual((GrowthModel())), coarse(GrowthModel(), {.cell = 0.3});
  EXPECT_GT(
      rms_difference(means_of(filter_all(usual, run.observations)), means_of(filter_all(coarse, run.observations))),
      1e-3);
}

TEST(ExactFilter, DensityIntegratesToOneAndIsThatOfTheEstimate) {
  ExactFilter filter((GrowthModel()));
  for (const double observation : GrowthModel().simulate(2).observations) {
    const UnivariateEstimate estimate = filter.step(observation);
    const double integral = 0.05 * std::accumulate(filter.density().begin(), filter.density().end(), 0.0);
    ASSERT_NEAR(integral, 1.0, 1e-9);
    const double mean =
        0.05 * std::inner_product(filter.density().begin(), filter.density().end(), filter.nodes().begin(), 0.0);
    ASSERT_NEAR(mean, estimate.mean, 1e-9);
  }
}

TEST(ExactFilter, NodesReachFromMinusFortyToForty) {
  const ExactFilter filter((GrowthModel()));
  EXPECT_NEAR(filter.nodes().front(), -40.0, 1e-9);
  EXPECT_NEAR(filter.nodes().back(), 40.0, 1e-9);
}

// Were the filter not exact, its own variance would not be its mean squared error.
TEST(ExactFilter, ErrorsOverTheirVarianceAreOneInTheMean) {
  const GrowthModel model;
  constexpr int kSeeds = 40;
  std::vector<double> ratios;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const GrowthRun run = model.simulate(seed);
    ExactFilter filter(model);
    double sum = 0.0;
    for (std::size_t i = 0; i < run.states.size(); ++i) {
      const UnivariateEstimate estimate = filter.step(run.observations[i]);
      sum += (run.states[i] - estimate.mean) * (run.states[i] - estimate.mean) / estimate.variance;
    }
    ratios.push_back(sum / 100.0);
  }
  const MeanInterval interval = paired_difference(ratios, std::vector<double>(kSeeds, 1.0));
  EXPECT_LT(std::abs(interval.mean), 4.0 / 1.96 * (interval.high - interval.mean));
  EXPECT_LT(interval.high - interval.low, 0.4);
}

TEST(ExactFilter, HasParticlesOfNoKind) { EXPECT_EQ(ExactFilter(GrowthModel()).step(3.0).effective_sample_size, 0.0); }

TEST(ExactFilter, RefusesTheSignAsPrintedAndCellsOfZero) {
  EXPECT_THAT([] { ExactFilter(GrowthModel({.denominator_sign = -1})); },
              ThrowsMessage<InputError>(HasSubstr("growth_model.denominator_sign = -1")));
  EXPECT_THAT([] { ExactFilter(GrowthModel(), {.cell = 0.0}); },
              ThrowsMessage<InputError>(HasSubstr("exact_filter.cell")));
  EXPECT_THAT([] { ExactFilter(GrowthModel(), {.half_width = 10.0}); },
              ThrowsMessage<InputError>(HasSubstr("exact_filter.half_width")));
}

}  // namespace
}  // namespace patrol::studies::exact_filter_test
