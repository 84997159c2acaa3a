#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "app/study/scan_world.h"
#include "importer/site/imported_site.h"

namespace patrol::app {

/// Differences of ranges at held-out poses. A beam returns up to an incidence of 85 degrees. Its difference is that of
/// the first surfaces; it is infinite if the world returns it and the site has no surface, or if the site returns it
/// and the world has no surface within 0.1 m of that range. A scanner sees a surface if the line to it is free, at most
/// 70 m long, not below the scanner's lowest elevation and at most at an incidence of 85 degrees. Beams past all
/// surfaces of the world count as seen.
struct RangeDifferences {
  double median_m = 0.0, p95_m = 0.0;
  double within_10cm = 0.0;       ///< fraction of beams
  double seen = 0.0;              ///< fraction of beams whose first surface in the world is seen by a scanner
  double seen_within_10cm = 0.0;  ///< fraction of these
  std::size_t num_beams = 0;
};

/// Comparison of a site with the true world.
struct SiteComparison {
  RangeDifferences planar, spatial;  ///< 2D: 720 beams to 30 m; 3D: 16 rings within 15 degrees, 360 beams to 100 m
  double ground_median_m = 0.0, ground_p95_m = 0.0;  ///< height of the ground for contact on the roads
  double person_hits = 0.0;      ///< fraction of beams to the removed person that hit a surface there only in the site
  double truck_hits = 0.0;       ///< fraction of beams to the removed truck that hit a surface there only in the site
  std::size_t num_phantoms = 0;  ///< held-out poses that are free in the world but touch a box of the site
};

/// Compares the site at `num_poses` poses on the roads with a clearance of 0.6 m, drawn with the seed. A pose is on
/// the level of the center line within 0.15 m.
SiteComparison compare_site(const ScannedWorld& world, const importer::ImportedSite& site, const std::string& site_xml,
                            int num_poses, std::uint64_t seed);

}  // namespace patrol::app
