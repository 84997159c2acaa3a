#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/site/map_in_site.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Consistency of the published covariances: normalized estimation error squared (NEES) e^T P^-1 e of x, y and yaw of
/// the body in site [BarShalom01, sec. 5.4]. P is the sum of the covariance of the pose in map and of that of the map's
/// registration to the site at the stamp. A consistent estimator has a mean of 3. More is overconfident, less
/// underconfident. Silent time has no published covariance and does not count (`time_coverage`, trajectory_error.h).
///
/// The instants are the stamps of the published poses within the time of the ground truth. A covariance is singular if
/// it is not finite, or a principal standard deviation is at most 1 um or 1 urad (yaw in rad counts like m). Such a
/// pose is not in `mean`, because its NEES is not defined. It counts as outside the ellipsoid: it claims certainty.
struct PoseNees {
  static constexpr int kDimension = 3;

  std::size_t num_instants = 0;
  std::size_t num_singular = 0;
  double mean = 0.0;       ///< mean over the instants with a regular covariance; 0 without any
  double within_95 = 0.0;  ///< fraction of all instants with the true pose inside the 95 % ellipsoid

  bool has_mean() const { return num_instants > num_singular; }
  double per_dimension() const { return mean / kDimension; }  ///< 1 for a consistent estimator
};

/// `covariances`: [pose of T_map_body], of x, y, yaw in map; m, m, rad.
PoseNees pose_nees(const Trajectory& T_map_body, const std::vector<Eigen::Matrix3d>& covariances, const MapInSite& map,
                   const Trajectory& T_world_body);

}  // namespace patrol::score
