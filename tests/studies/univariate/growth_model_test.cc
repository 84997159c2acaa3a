#include "studies/univariate/growth_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::studies::growth_model_test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kExactTol = 1e-12;

double greatest_magnitude(const GrowthModel& model, std::uint64_t seeds) {
  double greatest = 0.0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (const double state : model.simulate(seed).states) greatest = std::max(greatest, std::abs(state));
  }
  return greatest;
}

TEST(GrowthModel, LeadsFromOneToTwentyOneAtFirst) {
  EXPECT_NEAR(GrowthModel().transition(1.0, 1), 21.0, kExactTol);                         // 0.5 + 25 / 2 + 8 cos 0
  EXPECT_NEAR(GrowthModel().transition(-3.0, 2), -9.0 + 8.0 * std::cos(1.2), kExactTol);  // -1.5 - 75 / 10 + 8 cos 1.2
}

TEST(GrowthModel, AsPrintedLeadsFromTwoToMinusFifteenAndTwoThirds) {
  const GrowthModel model({.denominator_sign = -1});
  EXPECT_NEAR(model.drift(2.0), 1.0 - 50.0 / 3.0, kExactTol);  // 0.5 * 2 + 50 / (1 - 4)
}

TEST(GrowthModel, StaysWithinThirtyAndExplodesPastTenThousandAsPrinted) {
  EXPECT_LT(greatest_magnitude(GrowthModel(), 100), 30.0);
  EXPECT_GT(greatest_magnitude(GrowthModel({.denominator_sign = -1}), 100), 10'000.0);
}

TEST(GrowthModel, DoesNotDistinguishTenFromMinusTenByTheFiveItObserves) {
  const GrowthModel model;
  EXPECT_NEAR(GrowthModel::mean_observation(10.0), 5.0, kExactTol);
  EXPECT_NEAR(model.log_likelihood(5.0, 10.0), -0.5 * std::log(2.0 * std::numbers::pi), kExactTol);
  EXPECT_NEAR(model.log_likelihood(7.0, 10.0), -2.0 - 0.5 * std::log(2.0 * std::numbers::pi),
              kExactTol);  // -(7 - 5)^2 / 2
  EXPECT_EQ(model.log_likelihood(7.0, 10.0), model.log_likelihood(7.0, -10.0));
}

TEST(GrowthModel, LikelihoodOfVarianceFourIsFlatterByAFactorOfFour) {
  const GrowthModel model({.observation_var = 4.0});
  EXPECT_NEAR(model.log_likelihood(7.0, 10.0) - model.log_likelihood(5.0, 10.0), -0.5,
              kExactTol);  // -(7 - 5)^2 / (2 * 4)
}

TEST(GrowthModel, SimulatesNoiseOfItsVariances) {
  const GrowthModel model({.steps = 20'000, .process_var = 4.0, .observation_var = 0.25});
  const GrowthRun run = model.simulate(1);
  double before = 0.0, process = 0.0, process_square = 0.0, sensor = 0.0, sensor_square = 0.0;
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const double w = run.states[i] - model.transition(before, static_cast<int>(i) + 1),
                 v = run.observations[i] - GrowthModel::mean_observation(run.states[i]);
    process += w, process_square += w * w, sensor += v, sensor_square += v * v;
    before = run.states[i];
  }
  const double num = 20'000.0, mean_tol = 4.0 / std::sqrt(num),
               variance_tol = 4.0 * std::sqrt(2.0 / num);  // times the variance's root, the variance
  EXPECT_NEAR(process / num, 0.0, 2.0 * mean_tol);
  EXPECT_NEAR(process_square / num, 4.0, 4.0 * variance_tol);
  EXPECT_NEAR(sensor / num, 0.0, 0.5 * mean_tol);
  EXPECT_NEAR(sensor_square / num, 0.25, 0.25 * variance_tol);
}

TEST(GrowthModel, GivesTheSameRunForTheSameSeedOnly) {
  const GrowthModel model;
  EXPECT_EQ(model.simulate(7).states, model.simulate(7).states);
  EXPECT_EQ(model.simulate(7).observations, model.simulate(7).observations);
  EXPECT_NE(model.simulate(7).states, model.simulate(8).states);
  EXPECT_EQ(model.simulate(7).observations.size(), 100U);
}

TEST(GrowthModel, NamesTheSettingThatBreaksItsRule) {
  EXPECT_THAT([] { GrowthModel({.denominator_sign = 0}); },
              ThrowsMessage<InputError>(HasSubstr("growth_model.denominator_sign")));
  EXPECT_THAT([] { GrowthModel({.denominator_sign = 2}); },
              ThrowsMessage<InputError>(HasSubstr("growth_model.denominator_sign")));
  EXPECT_THAT([] { GrowthModel({.steps = 0}); }, ThrowsMessage<InputError>(HasSubstr("growth_model.steps")));
  EXPECT_THAT([] { GrowthModel({.process_var = 0.0}); },
              ThrowsMessage<InputError>(HasSubstr("growth_model.process_var")));
  EXPECT_THAT([] { GrowthModel({.observation_var = -1.0}); },
              ThrowsMessage<InputError>(HasSubstr("growth_model.observation_var")));
}

}  // namespace
}  // namespace patrol::studies::growth_model_test
