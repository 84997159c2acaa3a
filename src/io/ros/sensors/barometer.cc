#include <cmath>

#include "io/ros/ros_codec.h"

namespace patrol::io::ros {

template <typename Codec>
void describe(Codec& codec, FluidPressure& reading) {
  header(codec, reading.stamp, "imu");
  codec(reading.pressure_pa);
  double variance_pa2 = reading.std_pa * reading.std_pa;
  codec(variance_pa2);
  if constexpr (!Codec::kWrites) reading.std_pa = std::sqrt(variance_pa2);
}

}  // namespace patrol::io::ros

namespace patrol::io {

PATROL_ROS_SENSOR(FluidPressure, "std_msgs/Header header\nfloat64 fluid_pressure\nfloat64 variance\n");

}  // namespace patrol::io
