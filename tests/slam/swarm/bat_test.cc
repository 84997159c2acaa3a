#include "slam/swarm/bat.h"

#include "tests/slam/swarm/swarm_trial.h"

namespace patrol::slam::bat_test {
namespace {

using test::ackley, test::for_all, test::rosenbrock, test::run_trial, test::sphere, test::successes,
    test::worst_distance;

const BatOptimizer kBats({.iterations = 50});

// A bat judges only when it is loud enough for its draw: at most 20 x 51.
TEST(BatOptimizer, FindsAShiftedSphereToTwoCentimetersInAtMost1020Evaluations) {
  EXPECT_LE(run_trial(kBats, for_all(sphere), 20, 1).num_evaluations, 20 * 51);
  EXPECT_LT(worst_distance(kBats, sphere), 0.02);
}

// Two end in the bump beside it: a bat has no way out of one but its velocity.
TEST(BatOptimizer, FindsAckleysFunnelInEightOfTenSeeds) { EXPECT_GE(successes(kBats, ackley, 0.02), 8); }

TEST(BatOptimizer, FollowsRosenbrocksBentValleyInHalfOfTheSeeds) { EXPECT_GE(successes(kBats, rosenbrock, 0.2), 5); }

// Loudness zero: a better place is never taken, nor looked at.
TEST(BatOptimizer, SilentBatsStay) {
  const test::Trial trial = run_trial(BatOptimizer({.iterations = 50, .loudness = 0.0}), for_all(sphere), 20, 1);
  EXPECT_EQ(trial.end.positions, trial.start.positions);
  EXPECT_EQ(trial.num_evaluations, 20);
}

// Loudness that falls to nothing at the first success: every bat betters itself once at most.
TEST(BatOptimizer, LoudnessThatIsLostAtOnceAllowsOneStepEach) {
  const test::Trial once =
      run_trial(BatOptimizer({.iterations = 50, .loudness = 1.0, .loudness_decay = 0.0}), for_all(sphere), 20, 1);
  const test::Trial often =
      run_trial(BatOptimizer({.iterations = 50, .loudness = 1.0, .loudness_decay = 1.0}), for_all(sphere), 20, 1);
  EXPECT_EQ(often.num_evaluations, 20 * 51);
  EXPECT_LT(once.num_evaluations, often.num_evaluations);
  EXPECT_GT(once.distance(), often.distance());
}

TEST(BatOptimizer, NoMemberGetsWorse) { test::expect_nobody_worse(kBats); }

TEST(BatOptimizer, AConstantFitnessMovesNoMember) { test::expect_flat_fitness_moves_nobody(kBats); }

TEST(BatOptimizer, MembersAreEvaluatedByTheirOwnFitness) { test::expect_own_fitness(kBats); }

TEST(BatOptimizer, SameSeedSameResult) { test::expect_same_seed_same_result(kBats); }

}  // namespace
}  // namespace patrol::slam::bat_test
