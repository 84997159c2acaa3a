#include "plan/routes/potential_field.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/plan/routes/drawn_grid.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::potential_field_test {
namespace {

using ::patrol::test::VectorNear;

constexpr double kExactTol = 1e-12;

TEST(PotentialForces, OnFreeGroundPointAtTheGoalWithSizeOne) {
  const Grid<Eigen::Vector2d> forces =
      potential_forces({}, Grid<Cost>({.resolution_m = 1.0, .width = 9, .height = 9}), {4, 5});
  EXPECT_THAT(forces.at({1, 1}), VectorNear(Eigen::Vector2d(0.6, 0.8), kExactTol));
  EXPECT_THAT(forces.at({4, 5}), VectorNear(Eigen::Vector2d::Zero(), kExactTol));
}

// The cell is 1 from the lethal one below it and 6 from the goal on its right. Nearness 1 / 1 - 1 / 2 = 0.5. Away: 0.4
// x 0.5 x 6 / 1^2 = 1.2 upwards; towards the goal: 0.5 x 0.4 x 0.25 = 0.05; attraction 6. In shares of it: (6.05, 1.2)
// / 6.
TEST(PotentialForces, BesideALethalCellAreGeAndCuis) {
  const Grid<Cost> costs = test::draw({".......",  //
                                       "#......"});
  const Grid<Eigen::Vector2d> forces = potential_forces({.repulsion = 0.4, .obstacle_range_cells = 2.0}, costs, {6, 1});
  EXPECT_THAT(forces.at({0, 1}), VectorNear(Eigen::Vector2d(6.05, 1.2) / 6.0, kExactTol));
  EXPECT_THAT(forces.at({3, 1}), VectorNear(Eigen::Vector2d(1.0, 0.0), kExactTol)) << "out of range";
  EXPECT_THAT(forces.at({0, 0}), VectorNear(Eigen::Vector2d::Zero(), kExactTol)) << "lethal";
}

}  // namespace
}  // namespace patrol::plan::potential_field_test
