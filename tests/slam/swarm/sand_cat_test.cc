#include "slam/swarm/sand_cat.h"

#include "tests/slam/swarm/swarm_trial.h"

namespace patrol::slam::sand_cat_test {
namespace {

using test::ackley, test::for_all, test::rosenbrock, test::run_trial, test::sphere, test::successes,
    test::worst_distance;

const SandCatOptimizer kCats(50, false);
const SandCatOptimizer kImproved(50, true);

TEST(SandCatOptimizer, FindsAShiftedSphereToFiveCentimetersIn1020Evaluations) {
  EXPECT_EQ(run_trial(kCats, for_all(sphere), 20, 1).num_evaluations, 20 * 51);
  EXPECT_LT(worst_distance(kCats, sphere), 0.05);
}

TEST(SandCatOptimizer, FindsAckleysFunnelToATenthInTenOfTenSeeds) { EXPECT_EQ(successes(kCats, ackley, 0.1), 10); }

TEST(SandCatOptimizer, NoMemberGetsWorse) { test::expect_nobody_worse(kCats); }

TEST(SandCatOptimizer, AConstantFitnessMovesNoMember) { test::expect_flat_fitness_moves_nobody(kCats); }

TEST(SandCatOptimizer, MembersAreEvaluatedByTheirOwnFitness) { test::expect_own_fitness(kCats); }

TEST(SandCatOptimizer, SameSeedSameResult) { test::expect_same_seed_same_result(kCats); }

// One for the mutation of each generation, and S = ceil(19 sin(pi t / 100)) for those who stand in.
TEST(ImprovedSandCatOptimizer, FindsAShiftedSphereToFiveCentimetersIn1708Evaluations) {
  int num_inherited = 0;
  for (int t = 1; t <= 50; ++t)
    num_inherited += static_cast<int>(std::ceil(19.0 * std::sin(std::numbers::pi * t / 100.0)));
  EXPECT_EQ(num_inherited, 638);
  EXPECT_EQ(run_trial(kImproved, for_all(sphere), 20, 1).num_evaluations, 20 * 51 + 50 + num_inherited);
  EXPECT_LT(worst_distance(kImproved, sphere), 0.05);
}

// To 0.2, within the bump; the plain one finds it to 0.1. Those who stand in are copies, and the swarm gathers before
// it has found the place.
TEST(ImprovedSandCatOptimizer, FindsAckleysFunnelToAFifthInTenOfTenSeeds) {
  EXPECT_EQ(successes(kImproved, ackley, 0.2), 10);
}

// After T of T generations S = N - 1: all but one end at least as good as the second worst place of the generation
// before was for them, so that with one judge for all and one generation they end as good as the best 19 of 20 began.
TEST(ImprovedSandCatOptimizer, InTheLastGenerationTheWorstMoveToTheBest) {
  const test::Trial trial = run_trial(SandCatOptimizer(1, true), for_all(sphere), 20, 1);
  const std::vector<std::size_t> before = trial.start.ranking(), after = trial.end.ranking();
  EXPECT_GE(trial.end.fitness[after.back()], trial.start.fitness[before[18]]);
  EXPECT_GE(trial.end.fitness[after[10]], trial.start.fitness[before[10]]);
}

TEST(ImprovedSandCatOptimizer, NoMemberGetsWorse) { test::expect_nobody_worse(kImproved); }

TEST(ImprovedSandCatOptimizer, AConstantFitnessMovesNoMember) { test::expect_flat_fitness_moves_nobody(kImproved); }

TEST(ImprovedSandCatOptimizer, MembersAreEvaluatedByTheirOwnFitness) { test::expect_own_fitness(kImproved); }

TEST(ImprovedSandCatOptimizer, SameSeedSameResult) { test::expect_same_seed_same_result(kImproved); }

}  // namespace
}  // namespace patrol::slam::sand_cat_test
