#include "io/ros/ros_codec.h"

namespace patrol::io::ros {

template <typename Codec>
void describe(Codec& codec, RearLaserScan& scan) {
  scan_fields(codec, scan, "lidar_rear");
}

}  // namespace patrol::io::ros

namespace patrol::io {

PATROL_ROS_SENSOR(RearLaserScan, ros::kLaserScanFields);

}  // namespace patrol::io
