#include <cmath>

#include "io/ros/ros_codec.h"

namespace patrol::io::ros {

template <typename Codec>
void describe(Codec& codec, MagneticField& reading) {
  header(codec, reading.stamp, "imu");
  vector3(codec, reading.field_t);
  std::array<double, 9> covariance{};
  for (const std::size_t i : {0u, 4u, 8u}) covariance[i] = reading.std_t * reading.std_t;
  codec(covariance);
  if constexpr (!Codec::kWrites) reading.std_t = std::sqrt(covariance[0]);
}

}  // namespace patrol::io::ros

namespace patrol::io {

PATROL_ROS_SENSOR(
    MagneticField,
    "std_msgs/Header header\ngeometry_msgs/Vector3 magnetic_field\nfloat64[9] magnetic_field_covariance\n");

}  // namespace patrol::io
