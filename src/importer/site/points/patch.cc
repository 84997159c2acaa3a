#include "importer/site/points/patch.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/linear_algebra.h"

namespace patrol::importer {

Eigen::Vector3d Patch::area_normal() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Eigen::Vector3d first = corners_m[0].cast<double>();
  for (std::size_t i = 1; i + 1 < num_corners; ++i) {
    sum += (corners_m[i].cast<double>() - first).cross(corners_m[i + 1].cast<double>() - first);
  }
  return sum;
}

FittedPlane fit_plane(const PointMoments& moments) {
  FittedPlane plane;
  plane.center = moments.sum / moments.n;
  const Eigen::Matrix3d covariance = moments.products / moments.n - plane.center * plane.center.transpose();
  const SymmetricEigen<3> eigen = symmetric_eigen_direct(covariance);
  plane.axes = eigen.vectors;
  plane.std_m = eigen.values.cwiseMax(0.0).cwiseSqrt();
  return plane;
}

std::vector<Eigen::Vector3d> sample(const Patch& patch, double spacing_m) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Vector3d a = patch.corners_m[0].cast<double>();
  for (std::size_t k = 1; k + 1 < patch.num_corners; ++k) {
    const Eigen::Vector3d ab = patch.corners_m[k].cast<double>() - a, ac = patch.corners_m[k + 1].cast<double>() - a;
    const double max_length_m = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int steps = std::max(1, static_cast<int>(std::ceil(max_length_m / spacing_m)));
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= steps - i; ++j) points.push_back(a + (i * ab + j * ac) / steps);
    }
  }
  return points;
}

}  // namespace patrol::importer
