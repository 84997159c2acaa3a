#pragma once

#include <vector>

#include "core/time.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Poses of a log with the time at which each of them was received.
struct ReceivedPoses {
  const Trajectory& poses;
  const std::vector<Time>& received;  ///< [pose], log time, not decreasing
};

/// Pose of the body in `map` on a common clock, as a user of tf gets it (REP 105). The instants are the multiples of
/// 0.1 s from the first pose that is available to `end`, or `end` alone if no multiple lies between. They do not depend
/// on the stamps of the estimate, so a silent estimator is evaluated as well.
///
/// The pose at an instant is the newest correction map -> odom times the odometry. Messages received more than 0.2 s
/// after the instant are not used: a tf lookup waits that long for a transform. The newest correction is not later than
/// the instant. Odometry is interpolated, and held after its newest message. A correction is computed at the stamp of
/// the estimate. Without any odometry the newest estimate is held.
Trajectory live_trajectory(const ReceivedPoses& T_map_body, const ReceivedPoses& T_odom_body, Time end);

/// Poses that were received within 0.2 s of their stamp, i.e. while a tf lookup of their instant could use them.
Trajectory timely_poses(const ReceivedPoses& trajectory);

/// Odometry on the common clock: interpolated, and held after its newest message.
Trajectory live_odometry(const ReceivedPoses& T_odom_body, Time end);

}  // namespace patrol::score
