#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patrol::io {

/// Primitive value in a ROS 2 message: "header.stamp.sec" and "12", "ranges[417]" and "3.25".
struct RosField {
  std::string path;
  std::string value;
};

/// Returns all primitive values of a CDR message in order, by its definition as in MCAP. `type`: "pkg/msg/Type".
/// Throws InputError when the bytes do not match the definition. Bytes after the last field are allowed.
std::vector<RosField> ros_fields(const std::string& type, const std::string& definition, std::string_view bytes);

/// Throws InputError if the name of the type is not "pkg/msg/Type", or if a CDR message does not match its definition.
/// At most 3 bytes of padding may follow the last field. A type without fields has one byte, as in ROS 2; wstring is
/// not supported.
void check_ros_message(const std::string& type, const std::string& definition, std::string_view bytes);

}  // namespace patrol::io
