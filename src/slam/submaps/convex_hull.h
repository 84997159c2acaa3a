#pragma once

#include <Eigen/Core>

#include <vector>

namespace patrol::slam {

/// Corners of a convex polygon, counter-clockwise.
using ConvexPolygon = std::vector<Eigen::Vector2d>;

/// The smallest convex polygon that holds all points (Andrew's monotone chain, 1979). Fewer than three corners if they lie in one place or on one line.
ConvexPolygon convex_hull(std::vector<Eigen::Vector2d> points);

/// m^2.
double area_of(const ConvexPolygon& polygon);

/// What both hold (Sutherland, Hodgman 1974).
ConvexPolygon intersection_of(const ConvexPolygon& a, const ConvexPolygon& b);

}  // namespace patrol::slam
