#pragma once

#include <string>

namespace patrol::io {

/// Returns the text of a ROS 2 message definition in the format of MCAP: the definition of the type, then those of all
/// types that it uses. `type`: e.g. "sensor_msgs/msg/LaserScan". Throws std::logic_error for an unknown type.
std::string ros_definition(const std::string& type);

}  // namespace patrol::io
