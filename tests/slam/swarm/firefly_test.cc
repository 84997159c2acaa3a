#include "slam/swarm/firefly.h"

#include "tests/slam/swarm/swarm_trial.h"

namespace patrol::slam::firefly_test {
namespace {

using test::ackley, test::for_all, test::rosenbrock, test::run_trial, test::sphere, test::successes,
    test::worst_distance;

const FireflyOptimizer kFireflies({.iterations = 50});
const ImprovedFireflyOptimizer kImproved({.iterations = 50});

TEST(FireflyOptimizer, FindsAShiftedSphereToThreeCentimetersIn1020Evaluations) {
  EXPECT_EQ(run_trial(kFireflies, for_all(sphere), 20, 1).num_evaluations, 20 * 51);
  EXPECT_LT(worst_distance(kFireflies, sphere), 0.03);
}

// All fly to the brightest: where it is in the wrong bump, its step of half a meter at most does not lead out.
TEST(FireflyOptimizer, FindsAckleysFunnelInSixOfTenSeeds) { EXPECT_GE(successes(kFireflies, ackley, 0.03), 6); }

TEST(FireflyOptimizer, FollowsRosenbrocksBentValleyInHalfOfTheSeeds) {
  EXPECT_GE(successes(kFireflies, rosenbrock, 0.2), 5);
}

// No absorption, no random step, beta_0 = 1: the last flight of each ends at the brightest.
TEST(FireflyOptimizer, WithoutAbsorptionOneFlightEndsAtTheBrightest) {
  const FireflyOptimizer fireflies({.iterations = 1, .attractiveness = 1.0, .absorption = 0.0, .step = 0.0});
  const test::Trial trial = run_trial(fireflies, for_all(sphere), 20, 1);
  const Position brightest = trial.start.positions[trial.start.best()];
  for (const Position& position : trial.end.positions) EXPECT_LT((position - brightest).norm(), 1e-12);
}

// Two fireflies r = 2 apart: the dimmer flies beta_0 exp(-gamma r^2) r = 0.5 exp(-0.1 x 4) x 2 = 0.670320 of the way.
TEST(FireflyOptimizer, AFlightOfTwoIsTheFormulas) {
  const FireflyOptimizer fireflies({.iterations = 1, .attractiveness = 0.5, .absorption = 0.1, .step = 0.0});
  const Fitness fitness_of = [](std::size_t, const Position& position) { return position(0); };
  Swarm swarm = make_swarm({Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(2.0, 1.0)}, fitness_of);
  RandomSequence random(RandomStream(1, "test/swarm"), 0);
  fireflies.move(swarm, fitness_of, random);
  EXPECT_NEAR(swarm.positions[0](0), 0.670320, 1e-6);
  EXPECT_EQ(swarm.positions[0](1), 1.0);
  EXPECT_EQ(swarm.positions[1], Position(Eigen::Vector2d(2.0, 1.0)));
}

TEST(FireflyOptimizer, NoMemberGetsWorse) { test::expect_nobody_worse(kFireflies); }

TEST(FireflyOptimizer, AConstantFitnessMovesNoMember) { test::expect_flat_fitness_moves_nobody(kFireflies); }

TEST(FireflyOptimizer, MembersAreEvaluatedByTheirOwnFitness) { test::expect_own_fitness(kFireflies); }

TEST(FireflyOptimizer, SameSeedSameResult) { test::expect_same_seed_same_result(kFireflies); }

TEST(ImprovedFireflyOptimizer, FindsAShiftedSphereToThreeCentimetersIn1020Evaluations) {
  EXPECT_EQ(run_trial(kImproved, for_all(sphere), 20, 1).num_evaluations, 20 * 51);
  EXPECT_LT(worst_distance(kImproved, sphere), 0.03);
}

// Its step does not shrink for the brightest, alpha = exp(-1): more find the way out of a wrong bump.
TEST(ImprovedFireflyOptimizer, FindsAckleysFunnelInNineOfTenSeeds) { EXPECT_GE(successes(kImproved, ackley, 0.03), 9); }

TEST(ImprovedFireflyOptimizer, FollowsRosenbrocksBentValleyInHalfOfTheSeeds) {
  EXPECT_GE(successes(kImproved, rosenbrock, 0.3), 5);
}

// Far apart in the squared distance that the fitness is, I = 1 / (1 + 4): the dimmer's alpha is exp(-R / 5), the
// brighter's exp(-R). With R = 0 both are 1, and a step is alpha (u - 1 / 2); without attraction it is all there is.
TEST(ImprovedFireflyOptimizer, TheDimmersStepIsExpMinusRTimesTheRatioOfBrightness) {
  const ImprovedFireflyOptimizer fireflies({.iterations = 1, .attractiveness = 0.0, .noise_variance = 2.0});
  Swarm swarm{.positions = {Eigen::Vector2d(1.0, 1.0), Eigen::Vector2d(2.0, 2.0)},
              .fitness = {0.0, -8.0}};  // d = sqrt(2 x 8) = 4
  const Fitness likes_all = [calls = 1.0](std::size_t, const Position&) mutable { return calls += 1.0; };
  RandomSequence random(RandomStream(1, "test/swarm"), 0), draws(RandomStream(1, "test/swarm"), 0);
  fireflies.move(swarm, likes_all, random);
  for (Eigen::Index k = 0; k < 2; ++k)
    EXPECT_NEAR(swarm.positions[0](k), 1.0 + std::exp(-2.0) * (draws.uniform() - 0.5), 1e-12) << k;
  for (Eigen::Index k = 0; k < 2; ++k)
    EXPECT_NEAR(swarm.positions[1](k), 2.0 + std::exp(-2.0 / 5.0) * (draws.uniform() - 0.5), 1e-12) << k;
}

TEST(ImprovedFireflyOptimizer, NoMemberGetsWorse) { test::expect_nobody_worse(kImproved); }

TEST(ImprovedFireflyOptimizer, AConstantFitnessMovesNoMember) { test::expect_flat_fitness_moves_nobody(kImproved); }

TEST(ImprovedFireflyOptimizer, MembersAreEvaluatedByTheirOwnFitness) { test::expect_own_fitness(kImproved); }

TEST(ImprovedFireflyOptimizer, SameSeedSameResult) { test::expect_same_seed_same_result(kImproved); }

}  // namespace
}  // namespace patrol::slam::firefly_test
