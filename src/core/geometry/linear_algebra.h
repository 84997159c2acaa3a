#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Decompositions of small matrices by Eigen, compiled once: as templates they dominate the compile time of
/// the files that instantiate them.
namespace patrol {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Solution x of A x = b for a symmetric, positive or negative semidefinite A, by a pivoted LDLT decomposition. A pivot
/// that is zero or not a number contributes nothing: callers check finite input themselves.
Eigen::Vector2d solve_symmetric(const Eigen::Matrix2d& A, const Eigen::Vector2d& b);
Eigen::Vector3d solve_symmetric(const Eigen::Matrix3d& A, const Eigen::Vector3d& b);
Vector6d solve_symmetric(const Matrix6d& A, const Vector6d& b);

/// Cholesky factor: the lower triangular L with L L^T = A for a positive definite A.
Eigen::Matrix2d cholesky_factor(const Eigen::Matrix2d& A);
Eigen::Matrix3d cholesky_factor(const Eigen::Matrix3d& A);

/// Whether the symmetric matrix A is positive definite, i.e. has a finite Cholesky factor.
bool is_positive_definite(const Eigen::Matrix3d& A);

/// Eigenvalues of a symmetric matrix in ascending order, and its unit eigenvectors as columns in the same order.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// Eigendecomposition by QR iterations: accurate to rounding.
SymmetricEigen<2> symmetric_eigen(const Eigen::Matrix2d& A);
SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d& A);

/// Eigendecomposition in closed form: several times faster than symmetric_eigen, with errors up to the square root of
/// the rounding error for nearly equal eigenvalues.
SymmetricEigen<2> symmetric_eigen_direct(const Eigen::Matrix2d& A);
SymmetricEigen<3> symmetric_eigen_direct(const Eigen::Matrix3d& A);

/// Rotation by the smallest angle that turns the direction of `from` into that of `to`, vectors of any length but 0.
/// For opposite directions the axis is any one that is perpendicular to them.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace patrol
