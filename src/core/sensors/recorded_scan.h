#pragma once

#include "core/frames.h"
#include "core/sensors/lidar.h"

namespace patrol {

/// A scan of a recorded log, and where odometry had the robot then. The stamp is the log's own clock.
struct RecordedScan {
  LaserScan scan;
  Pose2 T_odom_body;
  Pose2 T_body_lidar;
  Pose2 T_first_last = {};  ///< how odometry says that the body moved from the first beam to the last; identity where the log does not say when each was fired
};

}  // namespace patrol
