#include "io/logs/run_log.h"

#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "io/mcap/mcap_reader.h"
#include "io/ros/ros_definitions.h"

namespace patrol::io {
namespace {

/// Time for which odometry is kept for estimates that arrive later.
constexpr Time kOdometryMemory = std::chrono::seconds(2);

}  // namespace

TransformSet sensor_mounts(const RobotDescription& robot) {
  TransformSet mounts;
  for (const auto& [frame, T_body_sensor] : robot.T_body_sensor) {
    mounts.transforms.push_back(
        {.stamp = {}, .parent = frame_id::kBody, .child = frame, .T_parent_child = T_body_sensor});
  }
  return mounts;
}

RunLogWriter::RunLogWriter(const std::filesystem::path& log_mcap, const RobotDescription& robot)
    : RunLogWriter(log_mcap, sensor_mounts(robot), {.joints = robot.joint_names}) {}

RunLogWriter::RunLogWriter(const std::filesystem::path& log_mcap, const TransformSet& mounts, RosNames names,
                           Time start)
    : writer_(log_mcap), names_(std::move(names)) {
  writer_.write(channel<TransformSet>(kStaticTransforms.topic), start, encode(mounts, names_));
}

void RunLogWriter::write_foreign(Time log_time, const std::string& topic, const std::string& type,
                                 const std::string& definition, std::string_view cdr) {
  writer_.write(channel_of(topic, type, definition), log_time, cdr);
}

McapWriter::ChannelId RunLogWriter::channel_of(const std::string& topic, const std::string& type,
                                               const std::string& definition) {
  const auto [known, is_new] = channels_.try_emplace({topic, type, definition});
  if (is_new) known->second = writer_.add_channel(topic, type, definition);
  return known->second;
}

void RunLogWriter::copy(const McapMessage& message) {
  const std::string& topic = message.channel.topic;
  if (topic == kStaticTransforms.topic) return;
  write_foreign(message.log_time, topic, message.channel.type, message.channel.definition, message.cdr);
  if (topic == kTopic<OdometryEstimate>) remember(decode<OdometryEstimate>(message.cdr));
}

McapWriter::ChannelId RunLogWriter::add_own_channel(const std::string& topic, const char* type) {
  return own_channels_[topic] = channel_of(topic, type, ros_definition(type));
}

// odom -> base_footprint (level) -> base_link.
void RunLogWriter::write_frames(Time log_time, const OdometryEstimate& odometry) {
  const Pose3 T_odom_level{odometry.T_odom_body.position, quaternion_from_yaw(to_yaw(odometry.T_odom_body.rotation))};
  const TransformSet frames{{
      {odometry.stamp, frame_id::kOdom, frame_id::kLevel, T_odom_level},
      {odometry.stamp, frame_id::kLevel, frame_id::kBody, T_odom_level.inverse() * odometry.T_odom_body},
  }};
  writer_.write(channel<TransformSet>(kTransforms.topic), log_time, encode(frames, names_));
  remember(odometry);
}

void RunLogWriter::remember(const OdometryEstimate& odometry) {
  if (odometry_.empty() || odometry_.back().stamp < odometry.stamp)
    odometry_.push_back({odometry.stamp, odometry.T_odom_body});
  if (odometry.stamp - odometry_.front().stamp > 2 * kOdometryMemory) {
    std::erase_if(odometry_, [&](const StampedPose& old) { return odometry.stamp - old.stamp > kOdometryMemory; });
  }
}

// map -> odom, so that map -> odom -> base_footprint is the estimate at its stamp.
void RunLogWriter::write_frames(Time log_time, const PoseEstimate& estimate) {
  if (odometry_.empty()) return;
  const Pose3 T_odom_body = pose_at(odometry_, estimate.stamp).value_or(odometry_.back().pose);
  const Pose2 T_map_odom = estimate.T_map_body * to_pose2(T_odom_body).inverse();
  const TransformSet frames{{{estimate.stamp, frame_id::kMap, frame_id::kOdom, to_pose3(T_map_odom)}}};
  writer_.write(channel<TransformSet>(kTransforms.topic), log_time, encode(frames, names_));
}

std::vector<std::string> LogHandlers::topics() const {
  std::vector<std::string> topics;
  for (const auto& [topic, handle] : by_topic_) topics.push_back(topic);
  return topics;
}

bool read_run_log(const std::filesystem::path& log_mcap, const LogHandlers& handlers, Time from, Time to) {
  const std::vector<std::string> topics = handlers.topics();
  McapReader reader(log_mcap, {.topics = topics, .from = from, .to = to});
  if (topics.empty()) return reader.is_complete();
  while (const std::optional<McapMessage> message = reader.next()) {
    try {
      handlers.handle(message->channel.topic, message->log_time, message->cdr);
    } catch (const DecodeError& error) {
      throw InputError(fmt::format("{}: {} at {:.9f} s: {}", log_mcap.string(), message->channel.topic,
                                   to_seconds(message->log_time), error.what()));
    }
  }
  return reader.is_complete();
}

}  // namespace patrol::io
