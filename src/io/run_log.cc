#include "io/run_log.h"

#include "io/mcap_reader.h"
#include "io/ros_definitions.h"

namespace patrol::io {
namespace {

constexpr const char* kTf = "/tf";
constexpr const char* kTfStatic = "/tf_static";

template <typename Message>
void dispatch(const McapMessage& message, const LogHandlers::Handler<Message>& handler) {
  if (handler && message.topic == kTopic<Message>) handler(message.log_time, decode<Message>(message.cdr));
}

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
  if (odometry_.size() > 64) odometry_.erase(odometry_.begin(), odometry_.begin() + 32);
}

// map -> odom, so that map -> odom -> base_footprint is the estimate at its stamp.
void RunLogWriter::write_frames(Time log_time, const PoseEstimate& estimate) {
  if (odometry_.empty()) return;
  const Pose3 T_odom_body = pose_at(odometry_, estimate.stamp).value_or(odometry_.back().pose);
  const Pose2 T_map_odom = estimate.T_map_body * to_planar(T_odom_body).inverse();
  const TransformSet frames{{{estimate.stamp, frame_id::kMap, frame_id::kOdom, to_spatial(T_map_odom)}}};
  writer_.write(channel<TransformSet>(kTf), log_time, encode(frames, names_));
}

bool read_run_log(const std::filesystem::path& log_mcap, const LogHandlers& handlers) {
  return read_mcap(log_mcap, [&](const McapMessage& message) {
    dispatch(message, handlers.scan);
    dispatch(message, handlers.points);
    dispatch(message, handlers.imu);
    dispatch(message, handlers.joints);
    dispatch(message, handlers.contacts);
    dispatch(message, handlers.gas);
    dispatch(message, handlers.gnss);
    dispatch(message, handlers.odometry);
    dispatch(message, handlers.pose);
    dispatch(message, handlers.particles);
    dispatch(message, handlers.map);
    dispatch(message, handlers.path);
    dispatch(message, handlers.command);
    dispatch(message, handlers.event);
    dispatch(message, handlers.truth);
    dispatch(message, handlers.state);
    dispatch(message, handlers.collision);
  });
}

}  // namespace patrol::io
