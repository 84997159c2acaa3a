#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "inspect/lining/lining_settings.h"
#include "inspect/lining/surface_cloud.h"

namespace patrol::inspect {

struct Registration {
  Pose3 T_target_source;
  double rms_m = 0.0;   ///< across the target's surfaces, of the sample's points that have a partner at last
  double share = 0.0;   ///< of the sample's points that have one, and lie no more than `last_distance_m` off its surface
  int iterations = 0;
  bool converged = false;
};

/// Lays a cloud on another: iterated closest points on the target's surfaces (Chen, Medioni 1992) in six degrees of freedom, on a
/// sample of all directions alike (Rusinkiewicz, Levoy, "Efficient Variants of the ICP Algorithm", 3DIM 2001, section 3.1), so that
/// the few surfaces that face along a tunnel hold it too. Pairs whose surfaces face differently are none, far ones count little
/// (Geman, McClure), and the distance up to which there are any shrinks, so that what has moved does not pull.
Registration register_cloud(const SurfaceCloud& target, const SurfaceCloud& source, const Pose3& T_target_source_start,
                            const RegistrationSettings& settings);

/// The pose after a small step: moved by `step`'s first three, turned by its last three about the origin of the source, in target.
Pose3 moved(const Pose3& T_target_source, const Eigen::Matrix<double, 6, 1>& step);

}  // namespace patrol::inspect
