#include "plan/perception/footprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace patrol::plan {
namespace {

/// Distance of the origin from the line of an edge; negative outside of a counter-clockwise polygon.
double distance_inside(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d edge = to - from;
  return (from.x() * edge.y() - from.y() * edge.x()) / edge.norm();
}

/// Divides the bounding box along its longer side into rows and across it into equal pieces, with a disc around each
/// piece. The number of pieces is the minimum for which the excess is at most `max_excess_m`.
std::vector<Disc> cover(const Eigen::AlignedBox2d& box, int rows, double max_excess_m) {
  const bool is_long = box.sizes().x() >= box.sizes().y();
  const double length = box.sizes().maxCoeff(), width = box.sizes().minCoeff() / rows;
  const double max_radius = width / 2.0 + max_excess_m;
  const double piece_limit = 2.0 * std::sqrt(max_radius * max_radius - width * width / 4.0);
  const int pieces = std::max(1, static_cast<int>(std::ceil(length / piece_limit - 1e-9)));
  const double piece = length / pieces;
  std::vector<Disc> discs;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < pieces; ++i) {
      const double along = (i + 0.5) * piece - length / 2.0;
      const double across = (row + 0.5 - rows / 2.0) * width;
      const Eigen::Vector2d offset = is_long ? Eigen::Vector2d(along, across) : Eigen::Vector2d(across, along);
      discs.push_back({.center_m = box.center() + offset, .radius_m = std::hypot(piece / 2.0, width / 2.0)});
    }
  }
  return discs;
}

}  // namespace

Footprint::Footprint(std::vector<Eigen::Vector2d> polygon_m, int rows, double max_excess_m)
    : polygon_m_(std::move(polygon_m)) {
  if (polygon_m_.size() < 3) {
    throw InputError(fmt::format("footprint: has {} corners: must have at least 3", polygon_m_.size()));
  }
  inscribed_radius_m_ = std::numeric_limits<double>::infinity();
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < polygon_m_.size(); ++i) {
    const Eigen::Vector2d& corner = polygon_m_[i];
    box.extend(corner);
    circumscribed_radius_m_ = std::max(circumscribed_radius_m_, corner.norm());
    inscribed_radius_m_ =
        std::min(inscribed_radius_m_, distance_inside(corner, polygon_m_[(i + 1) % polygon_m_.size()]));
  }
  if (!(inscribed_radius_m_ > 0.0)) {
    throw InputError("footprint: must be convex, counter-clockwise and contain the body's origin");
  }
  discs_ = cover(box, rows, max_excess_m);
}

}  // namespace patrol::plan
