#pragma once

#include <vector>

#include <Eigen/Core>

namespace patrol {

/// Corners of a convex polygon, counterclockwise.
using ConvexPolygon = std::vector<Eigen::Vector2d>;

/// Convex hull by the monotone chain algorithm [Andrew79]. Fewer than three corners if the points are coincident or
/// collinear.
ConvexPolygon convex_hull(std::vector<Eigen::Vector2d> points);

/// Area in m^2.
double polygon_area(const ConvexPolygon& polygon);

/// Intersection of two convex polygons [Sutherland74].
ConvexPolygon intersect_polygons(const ConvexPolygon& a, const ConvexPolygon& b);

}  // namespace patrol
