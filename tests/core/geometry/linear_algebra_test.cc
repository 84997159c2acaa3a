#include "core/geometry/linear_algebra.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace patrol::linear_algebra_test {
namespace {

constexpr double kTol = 1e-12;

TEST(SolveSymmetric, GivesTheClosedFormSolutionInTwoDimensions) {
  const Eigen::Matrix2d A{{2.0, 1.0}, {1.0, 3.0}};
  const Eigen::Vector2d x = solve_symmetric(A, Eigen::Vector2d(1.0, 2.0));  // (1/5) [3 -1; -1 2] (1, 2)
  EXPECT_NEAR(x[0], 0.2, kTol);
  EXPECT_NEAR(x[1], 0.6, kTol);
}

TEST(SolveSymmetric, SolvesNegativeDefiniteMatrices) {
  const Eigen::Matrix3d A = Eigen::Vector3d(-2.0, -4.0, -5.0).asDiagonal();
  EXPECT_TRUE(solve_symmetric(A, Eigen::Vector3d(2.0, 2.0, 1.0)).isApprox(Eigen::Vector3d(-1.0, -0.5, -0.2), kTol));
}

TEST(SolveSymmetric, LeavesAZeroDirectionAtZero) {
  const Eigen::Matrix3d A = Eigen::Vector3d(2.0, 0.0, 5.0).asDiagonal();
  EXPECT_TRUE(solve_symmetric(A, Eigen::Vector3d(2.0, 7.0, 1.0)).isApprox(Eigen::Vector3d(1.0, 0.0, 0.2), kTol));
}

// (I + u u^T)^-1 = I - u u^T / (1 + u^T u).
TEST(SolveSymmetric, InvertsARankOneUpdateOfTheIdentityInSixDimensions) {
  Vector6d u, b;
  u << 1.0, -2.0, 0.5, 0.0, 3.0, 0.25;
  b << 2.0, 1.0, -1.0, 4.0, 0.5, 8.0;
  const Vector6d expected = b - u * (u.dot(b) / (1.0 + u.squaredNorm()));
  EXPECT_TRUE(solve_symmetric(Matrix6d(Matrix6d::Identity() + u * u.transpose()), b).isApprox(expected, kTol));
}

TEST(CholeskyFactor, IsTheKnownLowerTriangle) {
  Eigen::Matrix3d L{{2.0, 0.0, 0.0}, {6.0, 1.0, 0.0}, {-8.0, 5.0, 3.0}};
  EXPECT_TRUE(cholesky_factor(Eigen::Matrix3d(L * L.transpose())).isApprox(L, kTol));
  const Eigen::Matrix2d A{{4.0, 2.0}, {2.0, 10.0}};
  EXPECT_TRUE(cholesky_factor(A).isApprox(Eigen::Matrix2d{{2.0, 0.0}, {1.0, 3.0}}, kTol));
}

TEST(IsPositiveDefinite, RefusesIndefiniteSingularAndInfiniteMatrices) {
  EXPECT_TRUE(is_positive_definite(Eigen::Matrix3d::Identity()));
  EXPECT_FALSE(is_positive_definite(Eigen::Matrix3d(Eigen::Vector3d(1.0, -1.0, 1.0).asDiagonal())));
  EXPECT_FALSE(is_positive_definite(Eigen::Matrix3d::Zero()));
  EXPECT_FALSE(is_positive_definite(Eigen::Matrix3d::Constant(std::numeric_limits<double>::infinity())));
}

// Rotation by `angle` about z of the axes with the variances 1, 4 and 9.
Eigen::Matrix3d turned_ellipsoid(double angle_rad) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() << std::cos(angle_rad), -std::sin(angle_rad), std::sin(angle_rad), std::cos(angle_rad);
  return R * Eigen::Vector3d(4.0, 1.0, 9.0).asDiagonal() * R.transpose();
}

TEST(SymmetricEigen, SortsTheAxesOfATurnedEllipsoid) {
  for (const SymmetricEigen<3>& eigen :
       {symmetric_eigen(turned_ellipsoid(0.3)), symmetric_eigen_direct(turned_ellipsoid(0.3))}) {
    EXPECT_TRUE(eigen.values.isApprox(Eigen::Vector3d(1.0, 4.0, 9.0), 1e-9));
    EXPECT_NEAR(std::abs(eigen.vectors.col(0).dot(Eigen::Vector3d(-std::sin(0.3), std::cos(0.3), 0.0))), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(eigen.vectors.col(1).dot(Eigen::Vector3d(std::cos(0.3), std::sin(0.3), 0.0))), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(eigen.vectors.col(2).z()), 1.0, 1e-9);
  }
}

TEST(SymmetricEigen, HasTheClosedFormValuesInTwoDimensions) {
  const Eigen::Matrix2d A{{2.0, 1.0}, {1.0, 3.0}};  // (5 -+ sqrt 5) / 2
  for (const SymmetricEigen<2>& eigen : {symmetric_eigen(A), symmetric_eigen_direct(A)}) {
    EXPECT_NEAR(eigen.values[0], 0.5 * (5.0 - std::sqrt(5.0)), kTol);
    EXPECT_NEAR(eigen.values[1], 0.5 * (5.0 + std::sqrt(5.0)), kTol);
    EXPECT_TRUE((eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose()).isApprox(A, kTol));
  }
}

TEST(RotationBetween, TurnsOneDirectionIntoTheOtherAboutTheirNormal) {
  const Eigen::Vector3d from(0.0, 0.0, 2.0), to(3.0, 0.0, 3.0);
  const Eigen::Quaterniond rotation = rotation_between(from, to);
  EXPECT_TRUE((rotation * from.normalized()).isApprox(to.normalized(), kTol));
  EXPECT_NEAR(rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.25 * std::numbers::pi, kTol);
  EXPECT_TRUE((rotation * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitY(), kTol));
}

TEST(RotationBetween, TurnsOppositeDirectionsByHalfATurn) {
  const Eigen::Vector3d from(1.0, -2.0, 0.5);
  const Eigen::Quaterniond rotation = rotation_between(from, -from);
  EXPECT_TRUE((rotation * from).isApprox(-from, kTol));
  EXPECT_NEAR(rotation.norm(), 1.0, kTol);
}

}  // namespace
}  // namespace patrol::linear_algebra_test
