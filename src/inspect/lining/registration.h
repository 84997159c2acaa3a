#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

struct Registration {
  Pose3 T_target_source;
  double rms_m = 0.0;  ///< root mean square distance of the final pairs from the target surfaces
  /// Inlier ratio: fraction of the sampled points with a pair at most `final_pair_distance_m` off its surface.
  double inlier_ratio = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// Registers a point cloud to another with point-to-plane ICP [Chen92] in six degrees of freedom. The sample is
/// balanced over the normal directions [Rusinkiewicz01, section 3.1], so that the few surfaces that face along a tunnel
/// also constrain the pose. Pairs with different normals are rejected and distant ones down-weighted (Geman-McClure).
/// The maximum pair distance decreases, which excludes deformed surfaces.
Registration register_cloud(const SurfaceCloud& target, const SurfaceCloud& source, const Pose3& T_target_source_start,
                            const RegistrationSettings& settings);

/// Applies a small step in target: the first three elements translate, the last three rotate about the origin of the
/// source.
Pose3 apply_step(const Pose3& T_target_source, const Eigen::Matrix<double, 6, 1>& step);

}  // namespace patrol::inspect
