#pragma once

#include "core/frames.h"
#include "core/sensors/lidar.h"

namespace patrol {

/// Scan of a recorded log with the odometry pose at its stamp. The stamp is in the clock of the log.
struct RecordedScan {
  LaserScan scan;
  Pose2 T_odom_body;
  Pose2 T_body_lidar;
  /// Odometry motion of the body from the first to the last beam; identity if the log has no beam times.
  Pose2 T_begin_end = {};
};

}  // namespace patrol
