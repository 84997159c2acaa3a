#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/trajectory.h"
#include "io/mcap_writer.h"
#include "io/ros_messages.h"

namespace patrol::io {

/// The topic of each message.
template <typename Message>
inline constexpr const char* kTopic = nullptr;
template <> inline constexpr const char* kTopic<LaserScan> = "/scan";
template <> inline constexpr const char* kTopic<PointCloud> = "/points";
template <> inline constexpr const char* kTopic<Imu> = "/imu/data";
template <> inline constexpr const char* kTopic<JointState> = "/joint_states";
template <> inline constexpr const char* kTopic<FootContacts> = "/foot_contacts";
template <> inline constexpr const char* kTopic<GasReading> = "/gas";
template <> inline constexpr const char* kTopic<GnssFix> = "/gnss/fix";
template <> inline constexpr const char* kTopic<TrackTicks> = "/track_ticks";
template <> inline constexpr const char* kTopic<UwbRange> = "/uwb/range";
template <> inline constexpr const char* kTopic<UltrasonicRange> = "/ultrasonic";
template <> inline constexpr const char* kTopic<DepthImage> = "/depth";
template <> inline constexpr const char* kTopic<RemoteCommand> = "/remote";
template <> inline constexpr const char* kTopic<PanoramicScan> = "/scanner/points";
template <> inline constexpr const char* kTopic<AntennaState> = "/tem/antenna";
template <> inline constexpr const char* kTopic<TemSounding> = "/tem/sounding";
template <> inline constexpr const char* kTopic<ScanCommand> = "/scanner/command";
template <> inline constexpr const char* kTopic<AntennaCommand> = "/tem/antenna_command";
template <> inline constexpr const char* kTopic<SoundingCommand> = "/tem/command";
template <> inline constexpr const char* kTopic<WarningCommand> = "/warning";
template <> inline constexpr const char* kTopic<LiningResult> = "/inspection/lining";
template <> inline constexpr const char* kTopic<WaterResult> = "/inspection/water";
template <> inline constexpr const char* kTopic<LocalizationTrust> = "/trust";
template <> inline constexpr const char* kTopic<OdometryEstimate> = "/odom";
template <> inline constexpr const char* kTopic<PoseEstimate> = "/pose";
template <> inline constexpr const char* kTopic<RangePoseEstimate> = "/uwb/pose";
template <> inline constexpr const char* kTopic<ParticleSet> = "/particles";
template <> inline constexpr const char* kTopic<MapUpdate> = "/map";
template <> inline constexpr const char* kTopic<Path> = "/plan";
template <> inline constexpr const char* kTopic<VelocityCommand> = "/cmd_vel";
template <> inline constexpr const char* kTopic<Event> = "/events";
template <> inline constexpr const char* kTopic<GroundTruth> = "/ground_truth/odom";
template <> inline constexpr const char* kTopic<SimState> = "/sim/state";
template <> inline constexpr const char* kTopic<Collision> = "/ground_truth/collisions";

/// Writes log.mcap: every message on its topic, and the frames on /tf and /tf_static.
class RunLogWriter {
 public:
  RunLogWriter(const std::filesystem::path& log_mcap, const RobotDescription& robot);

  template <typename Message>
  void write(Time log_time, const Message& message) {
    writer_.write(channel<Message>(kTopic<Message>), log_time, encode(message, names_));
    if constexpr (std::is_same_v<Message, OdometryEstimate>) write_frames(log_time, message);
    if constexpr (std::is_same_v<Message, PoseEstimate>) write_frames(log_time, message);
  }
  void write(Time log_time, const SensorMessage& message) {
    std::visit([&](const auto& content) { write(log_time, content); }, message);
  }

  void close() { writer_.close(); }

 private:
  template <typename Message>
  McapWriter::ChannelId channel(const char* topic) {
    const auto known = channels_.find(topic);
    if (known != channels_.end()) return known->second;
    return add_channel(topic, kRosType<Message>);
  }
  McapWriter::ChannelId add_channel(const std::string& topic, const char* type);
  void write_frames(Time log_time, const OdometryEstimate& odometry);
  void write_frames(Time log_time, const PoseEstimate& estimate);

  McapWriter writer_;
  RosNames names_;
  std::map<std::string, McapWriter::ChannelId> channels_;
  Trajectory odometry_;  ///< of late, to place map over odom at an estimate's stamp
};

/// What to do with each kind of message; those left empty are skipped undecoded.
struct LogHandlers {
  template <typename Message>
  using Handler = std::function<void(Time log_time, const Message&)>;
  Handler<LaserScan> scan = {};
  Handler<PointCloud> points = {};
  Handler<Imu> imu = {};
  Handler<JointState> joints = {};
  Handler<FootContacts> contacts = {};
  Handler<GasReading> gas = {};
  Handler<GnssFix> gnss = {};
  Handler<TrackTicks> ticks = {};
  Handler<UwbRange> uwb = {};
  Handler<UltrasonicRange> ultrasonic = {};
  Handler<DepthImage> depth = {};
  Handler<RemoteCommand> remote = {};
  Handler<PanoramicScan> panorama = {};
  Handler<AntennaState> antenna = {};
  Handler<TemSounding> sounding = {};
  Handler<ScanCommand> scan_command = {};
  Handler<AntennaCommand> antenna_command = {};
  Handler<SoundingCommand> sounding_command = {};
  Handler<WarningCommand> warning = {};
  Handler<LiningResult> lining = {};
  Handler<WaterResult> water = {};
  Handler<LocalizationTrust> trust = {};
  Handler<OdometryEstimate> odometry = {};
  Handler<PoseEstimate> pose = {};
  Handler<RangePoseEstimate> range_pose = {};
  Handler<ParticleSet> particles = {};
  Handler<MapUpdate> map = {};
  Handler<Path> path = {};
  Handler<VelocityCommand> command = {};
  Handler<Event> event = {};
  Handler<GroundTruth> truth = {};
  Handler<SimState> state = {};
  Handler<Collision> collision = {};
};

/// Reads a log in order, from one log time to another (both included); returns whether the log is complete: one that was
/// cut off by a crash is read up to the cut. Throws InputError, naming file and place, when it is damaged.
bool read_run_log(const std::filesystem::path& log_mcap, const LogHandlers& handlers, Time from = Time::min(),
                  Time to = Time::max());

}  // namespace patrol::io
