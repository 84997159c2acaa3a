#include "slam/graph/degeneracy.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::slam::degeneracy_test {
namespace {

/// Information of points on a wall: each constrains the distance to it.
Eigen::Matrix3d wall(double normal_rad, const Eigen::Vector2d& center, int count) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  const Eigen::Vector2d n(std::cos(normal_rad), std::sin(normal_rad));
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p = center + (0.1 * i - 0.05 * (count - 1)) * Eigen::Vector2d(-n.y(), n.x());
    const Eigen::Vector3d J(n.x(), n.y(), n.y() * p.x() - n.x() * p.y());
    sum += J * J.transpose();
  }
  return sum;
}

TEST(DegenerateDirection, OfTwoParallelWallsIsAlongThem) {
  const double heading = 0.7;  // of the walls
  const Eigen::Vector2d across(-std::sin(heading), std::cos(heading));
  const Eigen::Matrix3d corridor = wall(heading + M_PI / 2, across, 100) + wall(heading + M_PI / 2, -across, 100);
  const std::optional<Eigen::Vector2d> open = degenerate_direction(corridor, 0.02);
  ASSERT_TRUE(open);
  EXPECT_NEAR(std::abs(open->dot(Eigen::Vector2d(std::cos(heading), std::sin(heading)))), 1.0, 1e-9);
}

// An end wall of one point in fifty says a fiftieth of what the sides say: on either side of a threshold.
TEST(DegenerateDirection, IsNoneWhereAnEndWallConstrainsThePose) {
  const Eigen::Matrix3d sides = wall(M_PI / 2, {0.0, 1.0}, 100) + wall(M_PI / 2, {0.0, -1.0}, 100),
                        end = wall(0.0, {5.0, 0.0}, 4);
  EXPECT_FALSE(degenerate_direction(sides + end, 0.015));
  EXPECT_TRUE(degenerate_direction(sides + end, 0.025));
  EXPECT_FALSE(degenerate_direction(Eigen::Matrix3d::Zero(), 0.02));
}

TEST(DeterminedOffset, IsWithoutThePartAlongAWallThatHasNoEnd) {
  const Eigen::Matrix3d sides = wall(M_PI / 2, {0.0, 1.0}, 100) + wall(M_PI / 2, {0.0, -1.0}, 100);
  const Eigen::Vector3d offset(0.5, 0.1, 0.02);
  EXPECT_LT((determined_offset(offset, sides, 0.02) - Eigen::Vector3d(0.0, 0.1, 0.02)).norm(), 1e-9);
  EXPECT_EQ(determined_offset(offset, sides + wall(0.0, {5.0, 0.0}, 50), 0.02), offset);
}

TEST(ProjectOut, NothingIsLeftAlongItAndAllAcross) {
  const Eigen::Matrix3d information = wall(0.3, {4.0, 1.0}, 30) + wall(1.7, {-1.0, 3.0}, 20);
  const Eigen::Vector2d along(std::cos(0.4), std::sin(0.4)), across(-along.y(), along.x());
  const Eigen::Matrix3d rest = project_out(information, along);
  EXPECT_LT((rest * Eigen::Vector3d(along.x(), along.y(), 0.0)).norm(), 1e-12 * information.norm());
  const Eigen::Vector3d other(across.x(), across.y(), 0.0);
  EXPECT_NEAR(other.dot(rest * other), other.dot(information * other), 1e-12 * information.norm());
  EXPECT_NEAR(rest(2, 2), information(2, 2), 1e-12 * information.norm());
}

}  // namespace
}  // namespace patrol::slam::degeneracy_test
