#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/trajectory.h"
#include "io/logs/topics.h"
#include "io/mcap/mcap_reader.h"
#include "io/mcap/mcap_writer.h"

namespace patrol::io {

/// Returns the transforms from the body to the sensor frames, by the robot's model: the message on /tf_static.
TransformSet sensor_mounts(const RobotDescription& robot);

/// Writes log.mcap: every message on its topic, and the frames on /tf and /tf_static.
class RunLogWriter {
 public:
  RunLogWriter(const std::filesystem::path& log_mcap, const RobotDescription& robot);
  /// Log of a robot of which only the poses of the sensors are known. `start`: log time of the transforms.
  RunLogWriter(const std::filesystem::path& log_mcap, const TransformSet& mounts, RosNames names = {}, Time start = {});

  /// Writes a message and returns its encoding.
  template <typename Message>
  std::string write(Time log_time, const Message& message) {
    std::string cdr = encode(message, names_);
    write_encoded<Message>(log_time, cdr);
    return cdr;
  }
  /// Writes an encoded message.
  template <typename Message>
  void write_encoded(Time log_time, std::string_view cdr) {
    writer_.write(channel<Message>(kTopic<Message>), log_time, cdr);
    if constexpr (std::is_same_v<Message, OdometryEstimate> || std::is_same_v<Message, PoseEstimate>)
      write_frames(log_time, decode<Message>(cdr));  // a reader of the log computes the same frames
  }
  /// Writes an encoded message with its own type. `definition`: ROS 2 message definition. A topic may have messages of
  /// several types and definitions.
  void write_foreign(Time log_time, const std::string& topic, const std::string& type, const std::string& definition,
                     std::string_view cdr);

  /// Copies a message of another log of the same robot, so that writing continues as after it. Messages on /tf_static
  /// are skipped: each log has its own.
  void copy(const McapMessage& message);

  void close() { writer_.close(); }

 private:
  template <typename Message>
  McapWriter::ChannelId channel(const char* topic) {
    const auto known = own_channels_.find(topic);
    if (known != own_channels_.end()) return known->second;
    return add_own_channel(topic, kRosType<Message>);
  }
  McapWriter::ChannelId add_own_channel(const std::string& topic, const char* type);
  McapWriter::ChannelId channel_of(const std::string& topic, const std::string& type, const std::string& definition);
  void write_frames(Time log_time, const OdometryEstimate& odometry);
  void remember(const OdometryEstimate& odometry);
  void write_frames(Time log_time, const PoseEstimate& estimate);

  McapWriter writer_;
  RosNames names_;
  std::map<std::tuple<std::string, std::string, std::string>, McapWriter::ChannelId>
      channels_;                                               ///< channels by topic, type and definition
  std::map<std::string, McapWriter::ChannelId> own_channels_;  ///< channels of Patrol's messages, by topic
  Trajectory odometry_;  ///< recent odometry, to place map over odom at an estimate's stamp
};

/// Handlers of the messages of a log; messages without a handler are skipped undecoded.
class LogHandlers {
 public:
  template <typename Message>
  using Handler = std::function<void(Time log_time, const Message&)>;

  /// Sets the handler of a message that has a topic.
  template <typename Message>
  LogHandlers& on(Handler<Message> handler) {
    by_topic_[kTopic<Message>] = [handle = std::move(handler)](Time log_time, std::string_view cdr) {
      handle(log_time, decode<Message>(cdr));
    };
    return *this;
  }

  std::vector<std::string> topics() const;
  /// Decodes a message of one of the topics. Throws DecodeError.
  void handle(const std::string& topic, Time log_time, std::string_view cdr) const {
    by_topic_.at(topic)(log_time, cdr);
  }

 private:
  std::map<std::string, std::function<void(Time, std::string_view)>> by_topic_;
};

/// Reads a log in order, from one log time to another (both included); returns whether the log is complete: one that
/// was cut off by a crash is read up to the cut. Throws InputError, naming file and place, when it is damaged.
bool read_run_log(const std::filesystem::path& log_mcap, const LogHandlers& handlers, Time from = Time::min(),
                  Time to = Time::max());

}  // namespace patrol::io
