#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <vector>

namespace patrol::slam {

/// Throws InputError naming the first point that is not finite.
void check_finite(const std::vector<Eigen::Vector2d>& points);

/// A k-d tree over points in the plane (nanoflann). Equal distances are settled the same way every time.
class PointTree {
 public:
  /// Throws InputError when a point is not finite.
  explicit PointTree(std::vector<Eigen::Vector2d> points);
  ~PointTree();
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;

  const std::vector<Eigen::Vector2d>& points() const;

  struct Neighbour {
    std::size_t index = 0;
    double squared_distance_m2 = 0.0;
  };
  /// The tree must not be empty.
  Neighbour nearest(const Eigen::Vector2d& p) const;
  /// All within the radius, nearest first.
  std::vector<Neighbour> within(const Eigen::Vector2d& p, double radius_m) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

/// The piece of surface around a point.
struct SurfaceNormal {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< unit, either side; zero if fewer than three points are near
  double straightness = 0.0;  ///< 1: on a straight wall; 0: as wide as long (a corner, a bush), or nothing near
};

/// [point of the tree]: the principal axis across the points within the radius.
std::vector<SurfaceNormal> surface_normals(const PointTree& tree, double radius_m);

}  // namespace patrol::slam
