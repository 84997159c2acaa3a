#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "importer/site/points/panorama.h"

namespace patrol::importer {

/// Evidence of another scan about a point: none, beams pass through it, a surface is there, or a surface is there that
/// the other scan measures with closer beams.
enum class Evidence : std::uint8_t { kNone, kFree, kObserved, kCovered };

/// Point of a scan, in site.
struct SeenPoint {
  Eigen::Vector3d position, normal;
  double spacing_m;    ///< distance between the beams of its own scan on the surface
  double width_m;      ///< smaller extent of its surface
  double footprint_m;  ///< distance between the beams of its own scan across them
};

/// Returns the mean distance between beams on a surface: the geometric mean along both directions. `step_rad`: angle
/// between beams; `cosine`: cosine of the angle of incidence.
double spacing_on_surface_m(double range_m, double step_rad, double cosine);

/// Returns the evidence of another scan about a point.
Evidence evidence_of(const Panorama& other, const SeenPoint& seen);

}  // namespace patrol::importer
