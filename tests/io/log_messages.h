#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/mcap/mcap_writer.h"
#include "io/ros/ros_definitions.h"
#include "io/ros/ros_messages.h"

/// Messages that robots of other makers record, and the MCAP file that they are recorded in.
namespace patrol::test {

inline io::FrameTransform placed(const std::string& parent, const std::string& child, const Pose3& T_parent_child,
                                 Time stamp = {}) {
  return {.stamp = stamp, .parent = parent, .child = child, .T_parent_child = T_parent_child};
}

inline LaserScan scan_at(Time stamp, std::vector<float> ranges_m = {1.0F, 2.0F, 3.0F}) {
  return {.stamp = stamp,
          .angle_min_rad = -0.5,
          .angle_increment_rad = 0.25,
          .range_min_m = 0.5,
          .range_max_m = 30.0,
          .ranges_m = std::move(ranges_m),
          .intensities = {}};
}

inline CloudPoint cloud_point_at(const Eigen::Vector3d& position, double time_s = 0.0, int ring = 0) {
  return {.x = static_cast<float>(position.x()),
          .y = static_cast<float>(position.y()),
          .z = static_cast<float>(position.z()),
          .intensity = 0.0F,
          .time_s = static_cast<float>(time_s),
          .ring = static_cast<std::uint16_t>(ring)};
}

/// One metre a second along x, from x = 0 at 0 s.
inline OdometryEstimate odometry_at(Time stamp, double lead_m = 0.0) {
  OdometryEstimate odometry;
  odometry.stamp = stamp;
  odometry.T_odom_body.position = {to_seconds(stamp) + lead_m, 0.0, 0.3};
  return odometry;
}

class MessageFile {
 public:
  explicit MessageFile(const std::filesystem::path& file) : writer_(file) {}

  template <typename Message>
  void write(const std::string& topic, Time log_time, const Message& message) {
    write_cdr(topic, io::kRosType<Message>, log_time, io::encode(message));
  }
  void write_cdr(const std::string& topic, const std::string& type, Time log_time, const std::string& cdr) {
    if (!channels_.contains(topic)) channels_[topic] = writer_.add_channel(topic, type, io::ros_definition(type));
    writer_.write(channels_[topic], log_time, cdr);
  }
  void close() { writer_.close(); }

 private:
  io::McapWriter writer_;
  std::map<std::string, io::McapWriter::ChannelId> channels_;
};

}  // namespace patrol::test
