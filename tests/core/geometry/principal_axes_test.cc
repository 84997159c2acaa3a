#include "core/geometry/principal_axes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::symmetric_axes_test {
namespace {

TEST(PrincipalAxes, AreEigensOfTwoHundredRandomMatrices) {
  const RandomStream random(1, "test/axes");
  for (std::uint64_t i = 0; i < 200; ++i) {
    Eigen::Matrix2d root;
    root << random.normal(i, 0), random.normal(i, 1), random.normal(i, 2), random.normal(i, 3);
    const Eigen::Matrix2d matrix = root * root.transpose();
    const PrincipalAxes axes = principal_axes(matrix);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(matrix);
    EXPECT_NEAR(axes.large, solver.eigenvalues()[1], 1e-12 * axes.large);
    EXPECT_NEAR(axes.small, solver.eigenvalues()[0], 1e-9 * axes.large);
    EXPECT_LT((matrix * PrincipalAxes::along(axes.large_direction_rad) -
               axes.large * PrincipalAxes::along(axes.large_direction_rad))
                  .norm(),
              1e-12 * axes.large);
    EXPECT_LT((matrix * PrincipalAxes::along(axes.small_direction_rad()) -
               axes.small * PrincipalAxes::along(axes.small_direction_rad()))
                  .norm(),
              1e-12 * axes.large);
  }
}

TEST(PrincipalAxes, OfAFlatEllipseTheSmallOneKeepsItsDigits) {
  Eigen::Matrix2d matrix;
  matrix << 1e6, 0.0, 0.0, 1e-6;
  EXPECT_NEAR(principal_axes(matrix).small, 1e-6, 1e-18);
}

TEST(PrincipalAxes, ACircleAndNothingHaveAxesToo) {
  EXPECT_EQ(principal_axes(Eigen::Matrix2d::Identity()).small, 1.0);
  EXPECT_EQ(principal_axes(Eigen::Matrix2d::Zero()).large, 0.0);
  EXPECT_EQ(principal_axes(Eigen::Matrix2d::Zero()).small, 0.0);
}

}  // namespace
}  // namespace patrol::symmetric_axes_test
