#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>
#include <fastcdr/exceptions/NotEnoughMemoryException.h>
#include <fmt/format.h>

#include "io/ros/coordinate_limit.h"
#include "io/ros/ros_messages.h"

/// Building blocks of `encode` and `decode` (ros_messages.h), for the files that describe the fields of messages. Each
/// message has a function `describe(codec, message)` in this namespace.
namespace patrol::io::ros {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

/// Codec that writes: `codec(field)` serializes the field. One description of the fields serves Writer and Reader.
struct Writer {
  Cdr& cdr;
  const RosNames& names;
  static constexpr bool kWrites = true;
  template <typename T>
  void operator()(T& value) {
    cdr << value;
  }
};

/// Codec that reads: `codec(field)` fills the field.
struct Reader {
  Cdr& cdr;
  RosNames names{};
  bool has_unit_quaternions = true;  ///< whether all poses read before have unit quaternions
  static constexpr bool kWrites = false;
  template <typename T>
  void operator()(T& value) {
    cdr >> value;
  }
};

/// Codec that checks: whether every floating-point field is finite. It visits the fields that a Writer writes.
struct FiniteCheck {
  RosNames names{};
  bool is_finite = true;
  static constexpr bool kWrites = true;
  template <typename T>
  void operator()(const T& value) {
    if constexpr (std::is_floating_point_v<T>) is_finite = is_finite && std::isfinite(value);
  }
  template <typename T, std::size_t kSize>
  void operator()(const std::array<T, kSize>& values) {
    for (const T& value : values) (*this)(value);
  }
  template <typename T>
  void operator()(const std::vector<T>& values) {
    if constexpr (std::is_floating_point_v<T>) {
      for (const T& value : values) (*this)(value);
    }
  }
};

/// Codec that measures the coordinates of positions (`mark_position` below). It ignores other fields.
struct CoordinateCheck {
  RosNames names{};
  double max_m = 0.0;
  static constexpr bool kWrites = true;
  template <typename T>
  void operator()(const T&) {}
};

/// Marks a position among the fields of a message, beside its fields.
template <typename Codec>
void mark_position(Codec& codec, const Eigen::Vector3d& p_m) {
  if constexpr (std::is_same_v<Codec, CoordinateCheck>) codec.max_m = std::max(codec.max_m, p_m.cwiseAbs().maxCoeff());
}

template <typename Codec>
void time_field(Codec& codec, Time& time) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const auto whole = std::chrono::floor<std::chrono::seconds>(time);
  auto seconds = static_cast<std::int32_t>(whole.count());
  auto nanoseconds = static_cast<std::uint32_t>((time - whole).count());
  codec(seconds);
  codec(nanoseconds);
  time = Time{seconds * kSecond + nanoseconds};
}

template <typename Codec>
void header(Codec& codec, Time& stamp, std::string frame) {
  time_field(codec, stamp);
  codec(frame);
}

/// Field that is double in the program and float32 in ROS.
template <typename Codec>
void float_field(Codec& codec, double& value) {
  auto single = static_cast<float>(value);
  codec(single);
  if constexpr (!Codec::kWrites) value = single;
}

/// Fields of a sensor_msgs/LaserScan.
inline constexpr const char* kLaserScanFields =
    "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\nfloat32 time_increment\n"
    "float32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\nfloat32[] intensities\n";

/// Throws DecodeError if several beams have one angle, or if `angle_max_rad` is further than two increments from the
/// angle of the last beam: drivers differ by one.
inline void expect_angles(const LaserScan& scan, double angle_max_rad) {
  constexpr double kIncrements = 2.0;
  const auto num_steps = static_cast<double>(scan.ranges_m.size()) - 1.0;
  if (num_steps < 1.0) return;
  const double last_rad = scan.angle_min_rad + scan.angle_increment_rad * num_steps;
  const double increment_rad = std::abs(scan.angle_increment_rad);
  if (increment_rad == 0.0)
    throw DecodeError(fmt::format("angle_increment is 0 in a scan of {} beams", scan.ranges_m.size()));
  if (std::abs(angle_max_rad - last_rad) <= kIncrements * increment_rad) return;
  throw DecodeError(
      fmt::format("angle_max {:.4g} rad contradicts the angle of the last of {} beams, {:.4g} rad by angle_min and "
                  "angle_increment",
                  angle_max_rad, scan.ranges_m.size(), last_rad));
}

/// Scan of a 2D lidar whose frame is `frame`.
template <typename Codec>
void scan_fields(Codec& codec, LaserScan& scan, const char* frame) {
  header(codec, scan.stamp, frame);
  float_field(codec, scan.angle_min_rad);
  double angle_max_rad =
      scan.angle_min_rad + scan.angle_increment_rad * (static_cast<double>(scan.ranges_m.size()) - 1.0);
  float_field(codec, angle_max_rad);
  float_field(codec, scan.angle_increment_rad);
  float_field(codec, scan.time_increment_s);
  float_field(codec, scan.scan_time_s);
  float_field(codec, scan.range_min_m);
  float_field(codec, scan.range_max_m);
  codec(scan.ranges_m);
  codec(scan.intensities);
  if constexpr (!Codec::kWrites) expect_angles(scan, angle_max_rad);
}

template <typename Codec>
void vector3(Codec& codec, Eigen::Vector3d& v) {
  codec(v.x());
  codec(v.y());
  codec(v.z());
}

template <typename Codec>
void pose3(Codec& codec, Pose3& pose) {
  vector3(codec, pose.position);
  mark_position(codec, pose.position);
  codec(pose.rotation.x());
  codec(pose.rotation.y());
  codec(pose.rotation.z());
  codec(pose.rotation.w());
  if constexpr (!Codec::kWrites) {
    constexpr double kTolerance = 1e-3;
    const bool is_unit = std::abs(pose.rotation.norm() - 1.0) < kTolerance;
    codec.has_unit_quaternions = codec.has_unit_quaternions && is_unit;
  }
}

template <typename Codec>
void pose2(Codec& codec, Pose2& pose) {
  Pose3 spatial = to_pose3(pose);
  pose3(codec, spatial);
  if constexpr (!Codec::kWrites) pose = to_pose2(spatial);
}

/// Covariance of x, y, yaw within the 6 x 6 covariance of x, y, z, roll, pitch, yaw of ROS.
template <typename Codec>
void planar_covariance(Codec& codec, Eigen::Matrix3d& covariance) {
  constexpr std::array<std::size_t, 3> kRows = {0, 1, 5};
  std::array<double, 36> full{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      full[6 * kRows[static_cast<std::size_t>(i)] + kRows[static_cast<std::size_t>(j)]] = covariance(i, j);
  }
  codec(full);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      covariance(i, j) = full[6 * kRows[static_cast<std::size_t>(i)] + kRows[static_cast<std::size_t>(j)]];
  }
}

template <typename Codec>
void twist3(Codec& codec, Twist3& twist) {
  vector3(codec, twist.linear);
  vector3(codec, twist.angular);
}

/// List of messages of variable length.
template <typename Codec, typename Element, typename Describe>
void list(Codec& codec, std::vector<Element>& elements, const Describe& describe) {
  auto count = static_cast<std::uint32_t>(elements.size());
  codec(count);
  if constexpr (!Codec::kWrites) elements.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    if constexpr (!Codec::kWrites) elements.emplace_back();
    describe(elements[i]);
  }
}

/// Field of a sensor_msgs/PointCloud2.
struct CloudField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t type = 0;
  std::uint32_t count = 1;
};
inline constexpr std::uint8_t kFloat32 = 7, kUint16 = 4;

/// Fields of a PointCloud2 between its header and its data.
template <typename Codec>
void cloud_layout(Codec& codec, std::uint32_t num_points, const std::uint32_t step, std::vector<CloudField> fields) {
  std::uint32_t height = 1;
  codec(height);
  codec(num_points);
  list(codec, fields, [&](CloudField& field) {
    codec(field.name);
    codec(field.offset);
    codec(field.type);
    codec(field.count);
  });
  bool is_big_endian = false;
  std::uint32_t point_step = step, row_step = step * num_points;
  codec(is_big_endian);
  codec(point_step);
  codec(row_step);
  if (point_step != step) throw DecodeError("unsupported layout of a point cloud");
}

inline void read_head(Reader& reader, std::string& frame) {
  Time stamp{};
  time_field(reader, stamp);
  reader(frame);
}

/// Calls `read` with a reader of the bytes. Throws DecodeError "not a <type>: ...".
template <typename Read>
void read_cdr(std::string_view bytes, const char* type, const Read& read) {
  try {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): only read from
    FastBuffer buffer(const_cast<char*>(bytes.data()), bytes.size());
    Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    Reader reader{cdr};
    read(reader);
  } catch (const eprosima::fastcdr::exception::NotEnoughMemoryException&) {
    throw DecodeError(std::string("not a ") + type + ": the message is cut off");
  } catch (const eprosima::fastcdr::exception::Exception& error) {
    throw DecodeError(std::string("not a ") + type + ": " + error.what());
  }
}

/// Serializes a message and returns the number of bytes written.
template <typename Message>
std::size_t serialize(Message& message, const RosNames& names, FastBuffer& buffer) {
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  Writer writer{cdr, names};
  describe(writer, message);
  return cdr.getSerializedDataLength();
}

}  // namespace patrol::io::ros

namespace patrol::io {

// Serialized twice: Fast-CDR does not write padding, so the buffer must be zero before, and its size must be known.
template <typename Message>
std::string encode(const Message& message, const RosNames& names) {
  Message copy = message;
  ros::FastBuffer counted;
  std::string bytes(ros::serialize(copy, names, counted), '\0');
  ros::FastBuffer buffer(bytes.data(), bytes.size());
  ros::serialize(copy, names, buffer);
  return bytes;
}

template <typename Message>
Message decode(std::string_view bytes) {
  Message message;
  ros::read_cdr(bytes, kRosType<Message>, [&](ros::Reader& reader) { describe(reader, message); });
  return message;
}

template <typename Message>
bool has_unit_quaternions(std::string_view bytes) {
  Message message;
  bool has_unit = false;
  ros::read_cdr(bytes, kRosType<Message>, [&](ros::Reader& reader) {
    describe(reader, message);
    has_unit = reader.has_unit_quaternions;
  });
  return has_unit;
}

template <typename Message>
bool has_finite_numbers(const Message& message) {
  Message copy = message;
  ros::FiniteCheck check;
  describe(check, copy);
  return check.is_finite;
}

template <typename Message>
double max_coordinate_m(const Message& message) {
  Message copy = message;
  ros::CoordinateCheck check;
  describe(check, copy);
  return check.max_m;
}

}  // namespace patrol::io

/// Instantiates `encode`, `decode`, `has_finite_numbers`, `max_coordinate_m` and `has_unit_quaternions` of a message
/// with a `describe` function above.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): a template cannot instantiate others
#define PATROL_ROS_MESSAGE(Message)                              \
  template std::string encode(const Message&, const RosNames&);  \
  template bool has_finite_numbers(const Message&);              \
  template double max_coordinate_m(const Message&);              \
  template bool has_unit_quaternions<Message>(std::string_view); \
  template Message decode<Message>(std::string_view)

/// Instantiates `encode` and `decode` of a sensor message. `fields`: fields of its ROS type; "" for a type of
/// ros_definitions.cc.
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): a template cannot instantiate others
#define PATROL_ROS_SENSOR(Message, fields)         \
  template <>                                      \
  std::string_view ros_message_fields<Message>() { \
    return fields;                                 \
  }                                                \
  PATROL_ROS_MESSAGE(Message)
