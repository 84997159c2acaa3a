#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/convex_polygon.h"
#include "importer/site/points/panorama.h"

namespace patrol::importer {

/// Upright prism in site.
struct Prism {
  ConvexPolygon outline_m = {};
  double low_m = 0.0;
  double high_m = 0.0;
};

/// Beam of a scan past or onto an object, seen from above.
struct PlanBeam {
  Eigen::Vector2d origin_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
  double range_m = 0.0;   ///< range along `direction`; infinite without a return
  bool is_hit = false;    ///< whether it returned from the object or closer than 3 cm to it
  double height_m = 0.0;  ///< height of the beam at the object, above the middle of the prism
  std::size_t scan = 0;
  Pixel pixel = {};
};

/// Returns the beams that cross the circle around an upright prism, 5 cm wider than it, at a height between its ends.
/// Beams that end in front of the prism are left out, and rows if there are more than about `max_beams` of a scan.
std::vector<PlanBeam> beams_across(const Prism& prism, const std::vector<Panorama>& scans, int max_beams);

/// Crossing of a beam with a convex outline, seen from above.
struct PlanCrossing {
  double clearance_m = 0.0;  ///< distance at which the beam passes the outline; negative: depth of its crossing
  double entry_m = 0.0;      ///< range at which it enters the outline, if it does
  double chord_m = 0.0;      ///< length inside of the outline
};

/// `slope`: horizontal displacement of the outline per meter of height; the outline is that at the middle.
PlanCrossing crossing_of(const PlanBeam& beam, const ConvexPolygon& outline_m, const Eigen::Vector2d& slope);
PlanCrossing crossing_of(const PlanBeam& beam, const Eigen::Vector2d& center_m, double radius_m,
                         const Eigen::Vector2d& slope);

}  // namespace patrol::importer
