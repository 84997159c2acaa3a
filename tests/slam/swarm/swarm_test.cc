#include "slam/swarm/swarm.h"

#include <limits>

#include "tests/slam/swarm/swarm_trial.h"

namespace patrol::slam::swarm_test {
namespace {

Position at(double x, double y) { return Eigen::Vector2d(x, y); }

Swarm four_members() {
  return {.positions = {at(0, 0), at(1, 0), at(2, 0), at(3, 0)}, .fitness = {-2.0, -1.0, -5.0, -1.0}};
}

// One, not three, is the first of two equals.
TEST(Swarm, RanksMembersFromTheBestAndEqualsInOrder) {
  EXPECT_EQ(four_members().best(), 1U);
  EXPECT_EQ(four_members().ranking(), (std::vector<std::size_t>{1, 3, 0, 2}));
}

TEST(Swarm, AcceptsOnlyImprovementsOfTheMembersOwnFitness) {
  Swarm swarm = four_members();
  const Fitness fitness_of = [](std::size_t member, const Position&) { return member == 2 ? -4.0 : -9.0; };
  EXPECT_TRUE(swarm.accept(2, at(7, 7), fitness_of));
  EXPECT_EQ(swarm.positions[2], at(7, 7));
  EXPECT_EQ(swarm.fitness[2], -4.0);
  EXPECT_FALSE(swarm.accept(0, at(7, 7), fitness_of));
  EXPECT_EQ(swarm.positions[0], at(0, 0));
  EXPECT_EQ(swarm.fitness[0], -2.0);
}

TEST(Swarm, AcceptsNeitherAnEqualNorNotANumber) {
  Swarm swarm = four_members();
  EXPECT_FALSE(swarm.accept(0, at(7, 7), [](std::size_t, const Position&) { return -2.0; }));
  EXPECT_FALSE(
      swarm.accept(0, at(7, 7), [](std::size_t, const Position&) { return std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_EQ(swarm.positions[0], at(0, 0));
}

TEST(MakeSwarm, EvaluatesEachMemberOnceByItsOwnFitness) {
  const Fitness fitness_of = [](std::size_t member, const Position& position) {
    return 10.0 * static_cast<double>(member) + position.x();
  };
  const Swarm swarm = make_swarm({at(1, 0), at(2, 0), at(3, 0)}, fitness_of);
  EXPECT_EQ(swarm.fitness, (std::vector<double>{1.0, 12.0, 23.0}));
}

// The trial's own functions: the optimum is where it is said to be, and worth nothing.
TEST(TestFunctions, AreZeroAtTheOptimumAndLessATenthOfAMeterOff) {
  for (const auto& function : {test::sphere, test::rosenbrock, test::ackley}) {
    EXPECT_NEAR(function(test::kOptimum), 0.0, 1e-12);
    for (const Eigen::Vector2d& aside : {Eigen::Vector2d(0.1, 0.0), Eigen::Vector2d(-0.1, 0.0),
                                         Eigen::Vector2d(0.0, 0.1), Eigen::Vector2d(0.0, -0.1)}) {
      EXPECT_LT(function(test::kOptimum + aside), -0.009);
    }
  }
}

}  // namespace
}  // namespace patrol::slam::swarm_test
