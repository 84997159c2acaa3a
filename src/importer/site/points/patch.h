#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace patrol::importer {

/// Flat convex piece of a surface, in site.
struct Patch {
  std::array<Eigen::Vector3f, 6> corners_m = {};  ///< counterclockwise seen from the side that was measured
  std::uint8_t num_corners = 0;
  float reflectivity = 0.5f;  ///< 0 ... 1
  bool is_filled_in = false;  ///< interpolated between measured surfaces
  float spacing_m = 0.0f;     ///< distance between the beams on it

  /// Returns the normal with a length of twice the area.
  Eigen::Vector3d area_normal() const;
  double area_m2() const { return 0.5 * area_normal().norm(); }
};

/// Sums of the positions of points and of their products, for planes fitted by least squares.
struct PointMoments {
  double n = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& p) {
    n += 1.0;
    sum += p;
    products += p * p.transpose();
  }
  PointMoments& operator+=(const PointMoments& other) {
    n += other.n;
    sum += other.sum;
    products += other.products;
    return *this;
  }
};

/// Plane through the mean of points, with the standard deviations along its axes, ascending.
struct FittedPlane {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns; the first is the normal
  Eigen::Vector3d std_m = Eigen::Vector3d::Zero();

  Eigen::Vector3d normal() const { return axes.col(0); }
};

FittedPlane fit_plane(const PointMoments& moments);

/// Returns points on the patch that are at most `spacing_m` apart along its triangles, its corners included.
std::vector<Eigen::Vector3d> sample(const Patch& patch, double spacing_m);

}  // namespace patrol::importer
