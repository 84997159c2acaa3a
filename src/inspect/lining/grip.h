#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

/// A scan for `grip`: its points in any frame, and its scanner in that frame.
struct ScanView {
  const SurfaceCloud& cloud;
  Eigen::Vector3d p_scanner = Eigen::Vector3d::Zero();
};

struct Grip {
  int same = 0;       ///< points that the other scan has too
  int missing = 0;    ///< points whose place the other scan looks through
  double share() const { return same + missing > 0 ? static_cast<double>(same) / (same + missing) : 0.0; }
};

/// How well two scans agree on what faces along the tunnel, which alone tells one place of a tunnel from another. Of `one`'s points that
/// face along `axis_one`; what stands hidden in `other`, behind a truck or beyond its end, is not counted.
Grip grip(const ScanView& one, const ScanView& other, const Pose3& T_other_one, const Eigen::Vector3d& axis_one);

}  // namespace patrol::inspect
