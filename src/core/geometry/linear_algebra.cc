#include "core/geometry/linear_algebra.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace patrol {
namespace {

template <int N>
SymmetricEigen<N> eigen_of(const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>>& solver) {
  return {.values = solver.eigenvalues(), .vectors = solver.eigenvectors()};
}

template <int N>
SymmetricEigen<N> eigen_direct(const Eigen::Matrix<double, N, N>& A) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver;
  solver.computeDirect(A);
  return eigen_of<N>(solver);
}

}  // namespace

Eigen::Vector2d solve_symmetric(const Eigen::Matrix2d& A, const Eigen::Vector2d& b) { return A.ldlt().solve(b); }
Eigen::Vector3d solve_symmetric(const Eigen::Matrix3d& A, const Eigen::Vector3d& b) { return A.ldlt().solve(b); }
Vector6d solve_symmetric(const Matrix6d& A, const Vector6d& b) { return A.ldlt().solve(b); }

Eigen::Matrix2d cholesky_factor(const Eigen::Matrix2d& A) { return A.llt().matrixL(); }
Eigen::Matrix3d cholesky_factor(const Eigen::Matrix3d& A) { return A.llt().matrixL(); }

bool is_positive_definite(const Eigen::Matrix3d& A) {
  const Eigen::LLT<Eigen::Matrix3d> root(A);
  return root.info() == Eigen::Success && root.matrixLLT().allFinite();
}

SymmetricEigen<2> symmetric_eigen(const Eigen::Matrix2d& A) {
  return eigen_of<2>(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(A));
}
SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix3d& A) {
  return eigen_of<3>(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(A));
}

SymmetricEigen<2> symmetric_eigen_direct(const Eigen::Matrix2d& A) { return eigen_direct<2>(A); }
SymmetricEigen<3> symmetric_eigen_direct(const Eigen::Matrix3d& A) { return eigen_direct<3>(A); }

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  // As Eigen::Quaterniond::FromTwoVectors, which takes a singular value decomposition for opposite directions.
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = a.dot(b);
  Eigen::Quaterniond rotation;
  if (cosine < -1.0 + 1e-12) {
    rotation.w() = 0.0;
    rotation.vec() = a.unitOrthogonal();
  } else {
    const double size = std::sqrt(2.0 * (1.0 + cosine));
    rotation.w() = 0.5 * size;
    rotation.vec() = a.cross(b) * (1.0 / size);
  }
  return rotation;
}

}  // namespace patrol
