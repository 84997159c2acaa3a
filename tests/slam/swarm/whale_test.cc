#include "slam/swarm/whale.h"

#include "tests/slam/swarm/swarm_trial.h"

namespace patrol::slam::whale_test {
namespace {

using test::ackley, test::for_all, test::rosenbrock, test::run_trial, test::sphere, test::successes,
    test::worst_distance;

const WhaleOptimizer kWhales(50);

TEST(WhaleOptimizer, FindsAShiftedSphereToAMillimeterIn1020Evaluations) {
  EXPECT_EQ(run_trial(kWhales, for_all(sphere), 20, 1).num_evaluations, 20 * 51);
  EXPECT_LT(worst_distance(kWhales, sphere), 1e-3);
}

TEST(WhaleOptimizer, FindsAckleysFunnelInTenOfTenSeeds) { EXPECT_EQ(successes(kWhales, ackley, 1e-3), 10); }

TEST(WhaleOptimizer, FollowsRosenbrocksBentValleyInHalfOfTheSeeds) {
  EXPECT_GE(successes(kWhales, rosenbrock, 0.01), 5);
}

// Eqs. 2.1 to 2.8 with the same draws: a whale that encircles follows the best one only where |A| < 1, else any. The
// judge likes every move, so that the last one is always taken; the best at the start is the second.
TEST(WhaleOptimizer, OneGenerationIsTheFormulasInAHundredSeeds) {
  int num_spirals = 0, num_encircling = 0, num_searching = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const std::vector<Position> start = test::spread_out(3, seed);
    Swarm swarm{.positions = start, .fitness = {1.0, 3.0, 2.0}};
    const Fitness likes_all = [calls = 3.0](std::size_t, const Position&) mutable { return calls += 1.0; };
    RandomSequence random(RandomStream(seed, "test/swarm"), 0), draws(RandomStream(seed, "test/swarm"), 0);
    WhaleOptimizer(1).move(swarm, likes_all, random);
    std::vector<Position> whales = start;
    for (Position& whale : whales) {
      if (draws.uniform() < 0.5) {
        const double A = 4.0 * draws.uniform() - 2.0, C = 2.0 * draws.uniform();  // a = 2
        ++(std::abs(A) < 1.0 ? num_encircling : num_searching);
        const Position leader = std::abs(A) < 1.0 ? start[1] : whales[draws.index(3)];
        for (Eigen::Index k = 0; k < 2; ++k) whale(k) = leader(k) - A * std::abs(C * leader(k) - whale(k));
      } else {
        ++num_spirals;
        const double l = 2.0 * draws.uniform() - 1.0;
        for (Eigen::Index k = 0; k < 2; ++k)
          whale(k) =
              start[1](k) + std::abs(start[1](k) - whale(k)) * std::exp(l) * std::cos(2.0 * std::numbers::pi * l);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((swarm.positions[i] - whales[i]).norm(), 1e-12) << seed << ", " << i;
  }
  EXPECT_GT(num_spirals, 100);
  EXPECT_GT(num_encircling, 50);
  EXPECT_GT(num_searching, 50);
}

TEST(WhaleOptimizer, WithoutGenerationsNoMemberMoves) {
  const test::Trial trial = run_trial(WhaleOptimizer(0), for_all(sphere), 20, 1);
  EXPECT_EQ(trial.end.positions, trial.start.positions);
}

TEST(WhaleOptimizer, NoMemberGetsWorse) { test::expect_nobody_worse(kWhales); }

TEST(WhaleOptimizer, AConstantFitnessMovesNoMember) { test::expect_flat_fitness_moves_nobody(kWhales); }

TEST(WhaleOptimizer, MembersAreEvaluatedByTheirOwnFitness) { test::expect_own_fitness(kWhales); }

TEST(WhaleOptimizer, SameSeedSameResult) { test::expect_same_seed_same_result(kWhales); }

}  // namespace
}  // namespace patrol::slam::whale_test
