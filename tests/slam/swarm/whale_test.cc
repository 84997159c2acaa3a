#include "slam/swarm/whale.h"

#include "tests/slam/swarm/swarm_trial.h"

namespace patrol::slam {
namespace {

using test::ackley, test::for_all, test::rosenbrock, test::run_trial, test::sphere, test::successes, test::worst_distance;

const WhaleOptimizer kWhales(50);

TEST(WhaleOptimizer, FindsAShiftedSphereToAMillimetreIn1020Judgements) {
  EXPECT_EQ(run_trial(kWhales, for_all(sphere), 20, 1).num_judgements, 20 * 51);
  EXPECT_LT(worst_distance(kWhales, sphere), 1e-3);
}

TEST(WhaleOptimizer, FindsAckleysFunnelInTenOfTenSeeds) { EXPECT_EQ(successes(kWhales, ackley, 1e-3), 10); }

TEST(WhaleOptimizer, FollowsRosenbrocksBentValleyInHalfOfTheSeeds) { EXPECT_GE(successes(kWhales, rosenbrock, 0.01), 5); }

TEST(WhaleOptimizer, WithoutGenerationsNobodyMoves) {
  const test::Trial trial = run_trial(WhaleOptimizer(0), for_all(sphere), 20, 1);
  EXPECT_EQ(trial.end.positions, trial.start.positions);
}

TEST(WhaleOptimizer, LeavesNobodyWorse) { test::expect_nobody_worse(kWhales); }

TEST(WhaleOptimizer, AFlatFitnessMovesNobody) { test::expect_flat_fitness_moves_nobody(kWhales); }

TEST(WhaleOptimizer, MembersAreAcceptedByTheirOwnJudge) { test::expect_own_judge(kWhales); }

TEST(WhaleOptimizer, SameSeedSameResult) { test::expect_same_seed_same_result(kWhales); }

}  // namespace
}  // namespace patrol::slam
