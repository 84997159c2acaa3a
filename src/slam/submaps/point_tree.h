#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

namespace patrol::slam {

/// Throws InputError naming the first point that is not finite.
void check_finite(const std::vector<Eigen::Vector2d>& points);

/// K-d tree over points in the plane (nanoflann). Ties are resolved deterministically.
class PointTree {
 public:
  /// Throws InputError if a point is not finite.
  explicit PointTree(std::vector<Eigen::Vector2d> points);
  ~PointTree();
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;

  const std::vector<Eigen::Vector2d>& points() const;

  struct Neighbor {
    std::size_t index = 0;
    double squared_distance_m2 = 0.0;
  };
  /// Returns the nearest point; the tree must not be empty.
  Neighbor nearest(const Eigen::Vector2d& p) const;
  /// Returns all points within the radius, nearest first.
  std::vector<Neighbor> within(const Eigen::Vector2d& p, double radius_m) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

/// Normal of the local surface around a point.
struct SurfaceNormal {
  /// Unit normal, on either side; zero if fewer than three points are nearby.
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  /// Linearity: 1 on a straight wall; 0 if as wide as long (corner, bush) or without neighbors.
  double linearity = 0.0;
};

/// Normals of the points of the tree, [point]: the principal axis of smallest variance of the points within the radius.
std::vector<SurfaceNormal> surface_normals(const PointTree& tree, double radius_m);

}  // namespace patrol::slam
