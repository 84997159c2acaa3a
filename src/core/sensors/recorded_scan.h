#pragma once

#include "core/frames.h"
#include "core/sensors/lidar.h"

namespace patrol {

/// Scan of a recorded log with the odometry pose at its stamp. The stamp is in the log's clock.
struct RecordedScan {
  LaserScan scan;
  Pose2 T_odom_body;
  Pose2 T_body_lidar;
  Pose2 T_first_last = {};  ///< odometry motion of the body from the first to the last beam; identity if the log has no
                            ///< beam times
};

}  // namespace patrol
