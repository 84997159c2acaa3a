#pragma once

#include <string>

namespace patrol::io {

/// The full text of a ROS 2 message definition as MCAP wants it: the type's own, then those of everything it uses.
/// `type` is written "sensor_msgs/msg/LaserScan". An unknown type is a mistake of ours: std::logic_error.
std::string ros_definition(const std::string& type);

}  // namespace patrol::io
