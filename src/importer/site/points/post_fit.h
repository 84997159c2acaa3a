#pragma once

#include <optional>
#include <vector>

#include "core/geometry/convex_polygon.h"
#include "importer/site/points/beam_evidence.h"

namespace patrol::importer {

/// Outline of a post seen from above, fitted to beams.
struct FittedOutline {
  ConvexPolygon outline_m = {};                     ///< outline at the middle of the prism
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< horizontal displacement per meter of height
  double cost = 1.0;  ///< mean disagreement of the beams (`cost_of`), and 0.05 per slope of 1
};

/// Returns the mean disagreement of beams with a convex outline, 0 ... 1: for a beam that hits it, the square of the
/// difference of the ranges over 2 cm; for a beam that hits it on one side only, the depth or the clearance over 2 cm.
double cost_of(const std::vector<PlanBeam>& beams, const ConvexPolygon& outline_m);

/// Fits a circle, as a regular polygon of 16 corners with its mean radius, to the beams around `outline_m`. None if
/// fewer than 8 beams hit.
std::optional<FittedOutline> fit_circle(const std::vector<PlanBeam>& beams, const ConvexPolygon& outline_m);

/// Fits a rectangle; begins with the smallest one around `outline_m`.
std::optional<FittedOutline> fit_rectangle(const std::vector<PlanBeam>& beams, const ConvexPolygon& outline_m);

}  // namespace patrol::importer
