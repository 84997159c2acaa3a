#include "app/study/planner_problem.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "plan/routes/grid_search.h"

namespace patrol::app::planner_problem_test {
namespace {

using plan::GridSearch;

TEST(PlannerProblem, OfEveryWorldHasAPathBetweenDistantEnds) {
  for (const char* const world : {"street", "tunnel", "substation"}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const PlannerProblem problem = world_problem(world, seed);
      const plan::Route route = GridSearch(GridSearch::Method::kAstar).plan(problem.costs, problem.start, problem.goal);
      EXPECT_EQ(route.status, plan::PlanStatus::kFound) << world << " " << seed;
      EXPECT_GE(route.length, std::hypot(problem.costs.geometry().width, problem.costs.geometry().height) / 3.0)
          << world << " " << seed;
      EXPECT_GT(problem.costs.geometry().size(), 5000u) << world;
    }
  }
}

TEST(PlannerProblem, IsGeneratedFromTheSeed) {
  const PlannerProblem a = world_problem("tunnel", 7), b = world_problem("tunnel", 7), c = world_problem("tunnel", 8);
  EXPECT_EQ(a.start, b.start);
  EXPECT_EQ(a.goal, b.goal);
  EXPECT_EQ(a.costs.values(), b.costs.values());
  EXPECT_NE(a.start, c.start);
  EXPECT_NE(generated_problem("random", 30, 1).costs.values(), generated_problem("random", 30, 2).costs.values());
}

TEST(PlannerProblem, RefusesAWorldThatIsNone) { EXPECT_THROW(world_problem("moon", 1), InputError); }

}  // namespace
}  // namespace patrol::app::planner_problem_test
