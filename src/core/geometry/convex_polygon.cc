#include "core/geometry/convex_polygon.h"

#include <algorithm>
#include <utility>

namespace patrol {
namespace {

/// Twice the signed area of the triangle; positive if c is left of the line from a to b.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Right side of the hull along the order of `points`, without its last point.
ConvexPolygon half_hull(const std::vector<Eigen::Vector2d>& points) {
  ConvexPolygon side;
  for (const Eigen::Vector2d& p : points) {
    while (side.size() >= 2 && turn(side[side.size() - 2], side.back(), p) <= 0.0) side.pop_back();
    side.push_back(p);
  }
  side.pop_back();
  return side;
}

/// Part of the polygon left of the line from a to b.
ConvexPolygon clip_left_of(const ConvexPolygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  ConvexPolygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &p = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    const double at_p = turn(a, b, p), at_next = turn(a, b, next);
    if (at_p >= 0.0) kept.push_back(p);
    if ((at_p < 0.0 && at_next > 0.0) || (at_p > 0.0 && at_next < 0.0))
      kept.push_back(p + at_p / (at_p - at_next) * (next - p));
  }
  return kept;
}

}  // namespace

ConvexPolygon convex_hull(std::vector<Eigen::Vector2d> points) {
  std::ranges::sort(points,
                    [](const auto& a, const auto& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  ConvexPolygon hull = half_hull(points);
  std::ranges::reverse(points);
  const ConvexPolygon upper = half_hull(points);
  hull.insert(hull.end(), upper.begin(), upper.end());
  return hull;
}

double polygon_area(const ConvexPolygon& polygon) {
  double doubled = 0.0;
  for (std::size_t i = 2; i < polygon.size(); ++i) doubled += turn(polygon[0], polygon[i - 1], polygon[i]);
  return 0.5 * doubled;
}

ConvexPolygon intersect_polygons(const ConvexPolygon& a, const ConvexPolygon& b) {
  if (a.size() < 3 || b.size() < 3) return {};
  ConvexPolygon both = a;
  for (std::size_t i = 0; i < b.size() && !both.empty(); ++i) both = clip_left_of(both, b[i], b[(i + 1) % b.size()]);
  return both;
}

}  // namespace patrol
