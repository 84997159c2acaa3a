#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "importer/site/points/patch.h"
#include "importer/site/points/scanned_ground.h"

namespace patrol::importer {

struct ContactBoxSettings {
  double voxel_m = 0.1;              ///< edge of the voxels
  double lowest_m = 0.1;             ///< lowest height of obstacles above the ground
  double highest_m = 2.5;            ///< highest height of obstacles above the ground
  double min_area_m2 = 4e-4;         ///< smallest area of surfaces in an occupied voxel
  double min_group_area_m2 = 0.004;  ///< smallest area of surfaces in adjacent voxels
  double max_distance_m = 1.0;       ///< largest distance from measured ground: farther obstacles are out of reach
  double tolerance_m = 0.03;         ///< largest difference of the bounds of voxels that are joined
  double min_thickness_m = 0.02;     ///< smallest edge of a box
};

/// Returns boxes around the surfaces between two heights above the ground: the bounds of the surfaces within
/// each voxel, joined along z, x and y where their bounds along the other axes agree. Gaps of up to 0.3 m along z are
/// closed.
std::vector<Eigen::AlignedBox3d> contact_boxes(const std::vector<Patch>& patches, const ScannedGround& ground,
                                               const ContactBoxSettings& settings);

}  // namespace patrol::importer
