#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// Input of `axial_overlap`: points in any frame, and the scanner position in that frame.
struct ScanView {
  const SurfaceCloud& cloud;
  Eigen::Vector3d p_scanner = Eigen::Vector3d::Zero();
};

/// Axial overlap of two scans, in points.
struct AxialOverlap {
  int num_common = 0;   ///< points that are also in the other scan
  int num_missing = 0;  ///< points at positions that the other scan observed as free
  double ratio() const {
    return num_common + num_missing > 0 ? static_cast<double>(num_common) / (num_common + num_missing) : 0.0;
  }
};

/// Computes the axial overlap: the agreement of two scans on surfaces that face along the tunnel. Only such surfaces
/// distinguish positions along a tunnel. Counts the points of `one` whose normals are along `axis_one`. Points that are
/// occluded or out of range in `other` are not counted.
AxialOverlap axial_overlap(const ScanView& one, const ScanView& other, const Pose3& T_other_one,
                           const Eigen::Vector3d& axis_one);

}  // namespace patrol::inspect
