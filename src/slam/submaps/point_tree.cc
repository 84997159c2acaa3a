#include "slam/submaps/point_tree.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <nanoflann.hpp>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"

namespace patrol::slam {
namespace {

/// Adapter of a point set for nanoflann.
struct Cloud {
  std::vector<Eigen::Vector2d> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points[index][static_cast<Eigen::Index>(axis)];
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Cloud>, Cloud, 2, std::size_t>;

Cloud checked(std::vector<Eigen::Vector2d> points) {
  check_finite(points);
  return {std::move(points)};
}

}  // namespace

void check_finite(const std::vector<Eigen::Vector2d>& points) {
  for (const Eigen::Vector2d& p : points) {
    if (!p.allFinite()) throw InputError(fmt::format("point ({}, {}): must be finite", p.x(), p.y()));
  }
}

struct PointTree::Index {
  explicit Index(std::vector<Eigen::Vector2d> points) : cloud(checked(std::move(points))), tree(2, cloud) {}
  Cloud cloud;
  Tree tree;
};

PointTree::PointTree(std::vector<Eigen::Vector2d> points) : index_(std::make_unique<Index>(std::move(points))) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

const std::vector<Eigen::Vector2d>& PointTree::points() const { return index_->cloud.points; }

PointTree::Neighbor PointTree::nearest(const Eigen::Vector2d& p) const {
  assert(!points().empty());
  Neighbor found;
  index_->tree.knnSearch(p.data(), 1, &found.index, &found.squared_distance_m2);
  return found;
}

std::vector<PointTree::Neighbor> PointTree::within(const Eigen::Vector2d& p, double radius_m) const {
  std::vector<std::pair<std::size_t, double>> matches;
  index_->tree.radiusSearch(p.data(), radius_m * radius_m, matches, nanoflann::SearchParams());
  std::vector<Neighbor> found;
  found.reserve(matches.size());
  for (const auto& [index, squared] : matches) found.push_back({index, squared});
  return found;
}

namespace {

SurfaceNormal normal_of(const PointTree& tree, const std::vector<PointTree::Neighbor>& near) {
  if (near.size() < 3) return {};
  const auto count = static_cast<double>(near.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& neighbor : near) mean += tree.points()[neighbor.index] / count;
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const auto& neighbor : near) {
    const Eigen::Vector2d offset = tree.points()[neighbor.index] - mean;
    scatter += offset * offset.transpose();
  }
  const SymmetricEigen<2> axes = symmetric_eigen_direct(scatter);
  if (!(axes.values[1] > 0.0)) return {};  // coincident points
  return {.normal = axes.vectors.col(0), .linearity = 1.0 - std::max(0.0, axes.values[0]) / axes.values[1]};
}

}  // namespace

std::vector<SurfaceNormal> surface_normals(const PointTree& tree, double radius_m) {
  std::vector<SurfaceNormal> normals;
  normals.reserve(tree.points().size());
  for (const Eigen::Vector2d& p : tree.points()) normals.push_back(normal_of(tree, tree.within(p, radius_m)));
  return normals;
}

}  // namespace patrol::slam
