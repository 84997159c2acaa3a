#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/tunnel_lining.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// Design of the lining, aligned with the reference scan.
struct LiningInMap {
  TunnelLining design;    ///< in map
  double invert_m = 0.0;  ///< height of the design invert in map

  /// Returns a point of the intrados, in map.
  Eigen::Vector3d intrados(double chainage_m, double clock_deg) const;
};

/// Position of a point relative to the lining.
struct LiningPoint {
  double chainage_m = 0.0;
  double clock_deg = 0.0;  ///< -180 to 180: continuous at the crown
  double inward_m = 0.0;   ///< distance inside the design surface, toward the center of the half circle
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< gradient of `inward_m`, in map
};

/// Returns the position of a point relative to the lining.
LiningPoint lining_point(const LiningInMap& lining, const Eigen::Vector3d& p_map);

/// Cells around a station: rings in range, divided into sectors of the clock.
struct LiningGrid {
  int first_ring = 1, rings = 0;
  int half_sectors = 0;  ///< number of sectors on each side of the crown sector
  double sector_deg = 0.0;
  double ring_length_m = 0.0, first_ring_m = 0.0, joint_margin_m = 0.0;

  LiningGrid(const LiningInMap& lining, const Eigen::Vector3d& p_map_scanner, const LiningSettings& settings);

  int sectors() const { return 2 * half_sectors + 1; }
  int cells() const { return rings * sectors(); }
  int ring_of(int cell) const { return first_ring + cell / sectors(); }
  int sector_of(int cell) const { return cell % sectors(); }
  /// Returns the clock position of the center of a sector, 0 to 360.
  double clock_deg(int sector) const;
  /// Returns the cell of a point; -1 outside the grid and near ring joints.
  int cell_at(const LiningPoint& point) const;
};

/// Aligns the design with the points of the reference scan: lateral shift, yaw and height. Outliers inside the section
/// are down-weighted with Tukey's biweight. The chainage remains that of the map, because the section does not
/// constrain it. Returns nullopt if no crown is found above the scanner, or if fewer than a hundred points are within
/// 0.1 m of the section: the reference is not a scan of this lining.
std::optional<LiningInMap> fit_design(const TunnelLining& design_in_map,
                                      const std::vector<DownsampledPoint>& points_map,
                                      const Eigen::Vector3d& p_map_scanner, const LiningSettings& settings);

}  // namespace patrol::inspect
