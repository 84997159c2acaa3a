#pragma once

#include <vector>

#include "core/frames.h"
#include "core/time.h"
#include "core/trajectory.h"

namespace patrol::score {

/// The estimate at an instant, put into world, beside the truth at that same instant. Both level: what a robot on the
/// ground is asked for is x, y and heading.
struct MatchedPose {
  Time stamp{};
  Pose2 T_world_estimate;
  Pose2 T_world_truth;

  double position_error_m() const {
    return (T_world_estimate.position() - T_world_truth.position()).norm();
  }
  double heading_error_rad() const { return wrap_angle(T_world_estimate.yaw - T_world_truth.yaw); }
};

/// Where the estimate's frame lies in the world if both agree at their first common instant: the join of a surveyor who
/// puts the robot down at a known pose and corrects nothing afterwards. Throws InputError when no instant is common.
Pose2 join_at_start(const Trajectory& T_map_body, const Trajectory& T_world_body);

/// Every pose of the estimate that lies within the truth's time, with the truth interpolated to its stamp.
std::vector<MatchedPose> match_poses(const Trajectory& T_map_body, const Pose2& T_world_map,
                                     const Trajectory& T_world_body);

/// How far the estimate strays when nothing is fitted after the fact.
struct TrajectoryError {
  std::size_t num_poses = 0;
  double ate_rmse_m = 0.0;  ///< absolute trajectory error: planar distance to the truth
  double ate_mean_m = 0.0;
  double ate_max_m = 0.0;
  double heading_rmse_deg = 0.0;
  double rpe_trans_1m_m = 0.0;   ///< relative pose error, RMS over all stretches of 1 m of true way
  double rpe_rot_1m_deg = 0.0;
};

/// Throws InputError when the two have no instant in common.
TrajectoryError trajectory_error(const Trajectory& T_map_body, const Pose2& T_world_map,
                                 const Trajectory& T_world_body);

/// The same after a rigid motion in space that fits the estimate to the reference best (Umeyama 1991, without scale).
/// For comparison with other people's figures: it is what `evo_ape tum reference estimate --align` prints, and takes
/// pairs as that does: for each pose of the shorter trajectory the nearest stamp of the other, at most 10 ms away.
struct AlignedError {
  std::size_t num_pairs = 0;
  double rmse_m = 0.0;  ///< distance in space
  double mean_m = 0.0;
  double max_m = 0.0;
  Pose3 T_reference_estimate;  ///< the fit
};

/// Throws InputError when fewer than three pairs are found, or all on one point.
AlignedError aligned_error(const Trajectory& estimate, const Trajectory& reference);

}  // namespace patrol::score
