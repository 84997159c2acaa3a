#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/grid.h"
#include "importer/site/points/patch.h"

namespace patrol::importer {

/// Origin of the height of a cell of the ground.
enum class GroundOrigin : std::uint8_t {
  kMeasured,      ///< on a measured surface
  kInterpolated,  ///< in a hole of the measured ground, or next to it
  kExtrapolated,  ///< farther away
};

/// Heights of the ground of a site, in site.
struct ScannedGround {
  Grid<float> height_m;
  Grid<GroundOrigin> origin;

  /// Returns the height at a point; the nearest cell of the grid outside it.
  double height_at(const Eigen::Vector2d& p_m) const;
  /// Returns the area of the cells with this origin, m^2.
  double area_m2(GroundOrigin wanted) const;
};

struct ScannedGroundSettings {
  double resolution_m = 0.1;  ///< size of the cells
  double max_step_m = 0.12;   ///< largest step between neighboring cells
  double max_gap_m = 8.0;     ///< largest distance of an interpolated cell from a measured one, and of joined parts
  double min_cosine = 0.7;    ///< smallest cosine of the slope
  std::size_t max_cells = 6'000'000;  ///< cells become larger for larger sites
};

/// Finds the ground: the surface that is connected, by steps of at most `max_step_m`, to the surface around the
/// scanners, or for no scanners to the lowest large level surface. Patches must face upward if `is_oriented`. Holes are
/// filled smoothly. Throws InputError, beginning with `source`, if there is no level surface.
ScannedGround find_scanned_ground(const std::vector<Patch>& patches, const std::vector<Eigen::Vector3d>& scanners_m,
                                  bool is_oriented, const ScannedGroundSettings& settings, const std::string& source);

}  // namespace patrol::importer
