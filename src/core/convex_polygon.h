#pragma once

#include <Eigen/Core>

#include <vector>

namespace patrol {

/// Corners of a convex polygon, counter-clockwise.
using ConvexPolygon = std::vector<Eigen::Vector2d>;

/// Convex hull of a set of points (Andrew's monotone chain, 1979), without corners on a side. Points that coincide or lie on one line
/// give fewer than three corners.
ConvexPolygon convex_hull(std::vector<Eigen::Vector2d> points);

/// Area, m^2.
double area_of(const ConvexPolygon& polygon);

/// Intersection of two convex polygons (Sutherland, Hodgman 1974).
ConvexPolygon intersection_of(const ConvexPolygon& a, const ConvexPolygon& b);

}  // namespace patrol
