#pragma once

#include <vector>

#include "core/frames.h"
#include "core/time.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Estimated and true pose in world at one stamp. Both are planar poses of the level body.
struct MatchedPose {
  Time stamp{};
  Pose2 T_world_estimate;
  Pose2 T_world_truth;

  double position_error_m() const { return (T_world_estimate.position() - T_world_truth.position()).norm(); }
  double heading_error_rad() const { return wrap_angle(T_world_estimate.yaw - T_world_truth.yaw); }
};

/// Pose of the estimate's frame in world that makes both trajectories agree at their first common stamp. This models a
/// robot that starts at a known pose and is not corrected afterwards. Throws InputError when the trajectories do not
/// overlap in time.
Pose2 align_at_start(const Trajectory& T_map_body, const Trajectory& T_world_body);

/// Matches every pose of the estimate within the time range of the ground truth, interpolated to the pose's stamp.
/// Poses in holes of the ground truth (interpolation_limit.h) are left out.
std::vector<MatchedPose> pair_poses(const Trajectory& T_map_body, const Pose2& T_world_map,
                                    const Trajectory& T_world_body);

/// Trajectory error without any fit of the estimate to the ground truth.
struct TrajectoryError {
  std::size_t num_poses = 0;
  double ate_rmse_m = 0.0;  ///< absolute trajectory error: planar distance to the true position
  double ate_mean_m = 0.0;
  double ate_max_m = 0.0;
  double heading_rmse_deg = 0.0;
  double rpe_trans_1m_m = 0.0;  ///< relative pose error: RMS over all segments with 1 m of true distance
  double rpe_rot_1m_deg = 0.0;  ///< RMS relative rotation error over those segments
};

/// Throws InputError when the trajectories do not overlap in time.
TrajectoryError trajectory_error(const Trajectory& T_map_body, const Pose2& T_world_map,
                                 const Trajectory& T_world_body);

/// Fraction of the reference's time span that lies within 0.2 s of a pose of the estimate. 0 for an empty estimate. The
/// errors above do not see the rest of the span.
double time_coverage(const Trajectory& estimate, const Trajectory& reference);

/// Trajectory error after the best rigid motion in space of the estimate to the reference ([Umeyama91], without scale).
/// For comparison with published values: equals the output of `evo_ape tum reference estimate --align`. Pairs are
/// formed as in evo: each pose of the shorter trajectory with the nearest stamp of the other, at most `max_dt` apart.
/// Unlike evo, positions on a level line are aligned by the best motion in the plane.
struct AlignedError {
  std::size_t num_pairs = 0;
  double rmse_m = 0.0;  ///< distance in space (3D)
  double mean_m = 0.0;
  double max_m = 0.0;
  Pose3 T_reference_estimate;  ///< fitted rigid motion
};

constexpr Time kMaxAlignedDt = std::chrono::milliseconds(10);  ///< default of evo

/// Throws InputError for fewer than three pairs, or when the positions lie on a point or on a line that is not level.
AlignedError aligned_error(const Trajectory& estimate, const Trajectory& reference, Time max_dt = kMaxAlignedDt);

}  // namespace patrol::score
