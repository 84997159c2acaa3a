#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/sensors/registry.h"
#include "importer/site/points/patch.h"
#include "importer/site/points/scanned_ground.h"

namespace patrol::importer {

/// Patches of a point cloud without scanner positions. Their normals have no side yet.
struct CloudPatches {
  std::vector<Patch> patches;
  double cell_m = 0.0;           ///< smallest cell of the octree
  double noise_m = 0.0;          ///< median standard deviation of the points from the planes of the smallest cells
  std::size_t num_outliers = 0;  ///< points that are in no patch
};

/// Divides the points by an octree until those of a cell are on one plane that fills it, or to the smallest cell: 2 cm
/// times a power of two, the smallest in which the median number of points is at least six. Cells with fewer than three
/// points, or without neighbors, are outliers. `reflectivity`: of an intensity. Throws InputError, beginning with
/// `source`, for points without a surface.
CloudPatches patches_of_cloud(const std::vector<ScannerPoint>& points,
                              const std::function<float(float intensity)>& reflectivity, const std::string& source);

/// Turns each patch to the side of the nearest place where a person can stand: 1.5 m above ground that has no surface
/// between 0.3 and 1.8 m above it.
void orient(std::vector<Patch>& patches, const ScannedGround& ground);

}  // namespace patrol::importer
