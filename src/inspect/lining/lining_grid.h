#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/tunnel_lining.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// The design of the lining where the reference scan has it.
struct LiningInMap {
  TunnelLining design;     ///< in map
  double invert_m = 0.0;   ///< height of the design's invert in map

  /// A point of the intrados, in map.
  Eigen::Vector3d intrados(double chainage_m, double clock_deg) const;
};

/// Where a point is on the lining.
struct LiningPoint {
  double chainage_m = 0.0;
  double clock_deg = 0.0;    ///< -180 ... 180, so that the crown is nothing special
  double inward_m = 0.0;     ///< of the design, towards the half circle's centre
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of `inward_m`, in map
};

LiningPoint lining_point(const LiningInMap& lining, const Eigen::Vector3d& p_map);

/// The cells about a station: rings within reach by sectors of the clock.
struct LiningGrid {
  int first_ring = 1, rings = 0;
  int half_sectors = 0;         ///< sectors on either side of the one at the crown
  double sector_deg = 0.0;
  double ring_length_m = 0.0, first_ring_m = 0.0, joint_margin_m = 0.0;

  LiningGrid(const LiningInMap& lining, const Eigen::Vector3d& p_map_scanner, const LiningSettings& settings);

  int sectors() const { return 2 * half_sectors + 1; }
  int cells() const { return rings * sectors(); }
  int ring_of(int cell) const { return first_ring + cell / sectors(); }
  int sector_of(int cell) const { return cell % sectors(); }
  /// Of a sector's middle, 0 ... 360.
  double clock_deg(int sector) const;
  /// -1 outside, and near a joint.
  int cell_at(const LiningPoint& point) const;
};

/// The design laid on the points of the reference scan: how far it must be moved across the tunnel, turned and lifted, so that the lining lies
/// on it. What stands inside does not pull (Tukey's biweight). The chainage is the map's own: nothing in a section tells it. None where there
/// is no crown over the scanner, or fewer than a hundred points lie within 0.1 m of the section: the reference is not a scan of this lining.
std::optional<LiningInMap> fit_design(const TunnelLining& design_in_map, const std::vector<ThinPoint>& points_map,
                                      const Eigen::Vector3d& p_map_scanner, const LiningSettings& settings);

}  // namespace patrol::inspect
