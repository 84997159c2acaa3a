#include "io/run_log.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/mcap_reader.h"
#include "io/ros_definitions.h"

namespace patrol::io {
namespace {

constexpr const char* kTf = "/tf";
constexpr const char* kTfStatic = "/tf_static";

/// How long odometry is kept for the estimates that come later than it.
constexpr Time kOdometryMemory = std::chrono::seconds(2);

/// What to do with the messages of each topic that someone asked for.
class Dispatch {
 public:
  template <typename Message>
  void add(const LogHandlers::Handler<Message>& handler) {
    if (!handler) return;
    by_topic_[kTopic<Message>] = [&handler](const McapMessage& message) {
      handler(message.log_time, decode<Message>(message.cdr));
    };
  }

  std::vector<std::string> topics() const {
    std::vector<std::string> topics;
    for (const auto& [topic, handle] : by_topic_) topics.push_back(topic);
    return topics;
  }
  void operator()(const McapMessage& message) const { by_topic_.at(message.channel.topic)(message); }

 private:
  std::map<std::string, std::function<void(const McapMessage&)>> by_topic_;
};

}  // namespace

RunLogWriter::RunLogWriter(const std::filesystem::path& log_mcap, const RobotDescription& robot)
    : writer_(log_mcap), names_{.joints = robot.joint_names} {
  TransformSet mounts;
  for (const auto& [frame, T_body_sensor] : robot.T_body_sensor) {
    mounts.transforms.push_back({.stamp = {}, .parent = frame_id::kBody, .child = frame, .T_parent_child = T_body_sensor});
  }
  writer_.write(channel<TransformSet>(kTfStatic), Time{}, encode(mounts, names_));
}

McapWriter::ChannelId RunLogWriter::add_channel(const std::string& topic, const char* type) {
  return channels_[topic] = writer_.add_channel(topic, type, ros_definition(type));
}

// odom -> base_footprint (level) -> base_link.
void RunLogWriter::write_frames(Time log_time, const OdometryEstimate& odometry) {
  const Pose3 T_odom_level{odometry.T_odom_body.position, quaternion_from_yaw(yaw_of(odometry.T_odom_body.rotation))};
  const TransformSet frames{{
      {odometry.stamp, frame_id::kOdom, frame_id::kLevel, T_odom_level},
      {odometry.stamp, frame_id::kLevel, frame_id::kBody, T_odom_level.inverse() * odometry.T_odom_body},
  }};
  writer_.write(channel<TransformSet>(kTf), log_time, encode(frames, names_));
  if (odometry_.empty() || odometry_.back().stamp < odometry.stamp) odometry_.push_back({odometry.stamp, odometry.T_odom_body});
  if (odometry.stamp - odometry_.front().stamp > 2 * kOdometryMemory) {
    std::erase_if(odometry_, [&](const StampedPose& old) { return odometry.stamp - old.stamp > kOdometryMemory; });
  }
}

// map -> odom, so that map -> odom -> base_footprint is the estimate at its stamp.
void RunLogWriter::write_frames(Time log_time, const PoseEstimate& estimate) {
  if (odometry_.empty()) return;
  const Pose3 T_odom_body = pose_at(odometry_, estimate.stamp).value_or(odometry_.back().pose);
  const Pose2 T_map_odom = estimate.T_map_body * to_planar(T_odom_body).inverse();
  const TransformSet frames{{{estimate.stamp, frame_id::kMap, frame_id::kOdom, to_spatial(T_map_odom)}}};
  writer_.write(channel<TransformSet>(kTf), log_time, encode(frames, names_));
}

bool read_run_log(const std::filesystem::path& log_mcap, const LogHandlers& handlers, Time from, Time to) {
  Dispatch dispatch;
  dispatch.add(handlers.scan);
  dispatch.add(handlers.points);
  dispatch.add(handlers.imu);
  dispatch.add(handlers.joints);
  dispatch.add(handlers.contacts);
  dispatch.add(handlers.gas);
  dispatch.add(handlers.gnss);
  dispatch.add(handlers.ticks);
  dispatch.add(handlers.uwb);
  dispatch.add(handlers.ultrasonic);
  dispatch.add(handlers.depth);
  dispatch.add(handlers.remote);
  dispatch.add(handlers.panorama);
  dispatch.add(handlers.antenna);
  dispatch.add(handlers.sounding);
  dispatch.add(handlers.scan_command);
  dispatch.add(handlers.antenna_command);
  dispatch.add(handlers.sounding_command);
  dispatch.add(handlers.warning);
  dispatch.add(handlers.lining);
  dispatch.add(handlers.water);
  dispatch.add(handlers.trust);
  dispatch.add(handlers.odometry);
  dispatch.add(handlers.pose);
  dispatch.add(handlers.range_pose);
  dispatch.add(handlers.particles);
  dispatch.add(handlers.map);
  dispatch.add(handlers.path);
  dispatch.add(handlers.command);
  dispatch.add(handlers.event);
  dispatch.add(handlers.truth);
  dispatch.add(handlers.state);
  dispatch.add(handlers.collision);
  const std::vector<std::string> topics = dispatch.topics();
  McapReader reader(log_mcap, {.topics = topics, .from = from, .to = to});
  if (topics.empty()) return reader.is_complete();
  while (const std::optional<McapMessage> message = reader.next()) {
    try {
      dispatch(*message);
    } catch (const DecodeError& error) {
      throw InputError(fmt::format("{}: {} at {:.9f} s: {}", log_mcap.string(), message->channel.topic,
                                   to_seconds(message->log_time), error.what()));
    }
  }
  return reader.is_complete();
}

}  // namespace patrol::io
