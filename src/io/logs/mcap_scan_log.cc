#include "io/logs/mcap_scan_log.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/one_line.h"
#include "io/logs/cloud_slice.h"
#include "io/logs/run_log.h"
#include "io/ros/point_cloud2.h"

namespace patrol::io {
namespace {

constexpr std::size_t kMaxWaiting = 256;  ///< maximum number of waiting scans; later odometry is treated as missing
constexpr std::size_t kMaxBeams = 10'000;
constexpr double kQuaternionTolerance = 1e-3;  ///< tolerance of the norm of a quaternion
constexpr double kMaxPoseDistance_m = 1e8;
constexpr double kMaxScanAngle_rad = 7.0;  ///< one turn plus rounding
constexpr double kMaxRateRadps = 1e3;      ///< maximum plausible rate
constexpr std::size_t kMaxNamespaces = 50;
constexpr const char* kTfStaticSuffix = "/tf_static";

void expect_pose(const Pose3& pose, const char* whose) {
  const bool is_pose = pose.position.allFinite() && pose.position.cwiseAbs().maxCoeff() <= kMaxPoseDistance_m &&
                       std::abs(pose.rotation.norm() - 1.0) <= kQuaternionTolerance;
  if (!is_pose) throw DecodeError(fmt::format("{}: invalid pose: must be finite, with a unit quaternion", whose));
}

Pose3 normalized(const Pose3& pose) { return {pose.position, pose.rotation.normalized()}; }

bool is_static_topic(const std::string& topic) { return topic.ends_with(kTfStaticSuffix); }

void expect_cdr(const McapMessage& message) {
  const std::string& encoding = message.channel.message_encoding;
  if (encoding != "cdr") throw DecodeError(fmt::format("message encoding is {}: must be cdr", on_one_line(encoding)));
}

std::vector<FrameTransform> transforms_of(const McapMessage& message) {
  expect_cdr(message);
  std::vector<FrameTransform> transforms = decode<TransformSet>(message.cdr).transforms;
  for (FrameTransform& transform : transforms) {
    expect_pose(transform.T_parent_child, "transform");
    transform.T_parent_child = normalized(transform.T_parent_child);
  }
  return transforms;
}

void expect_scan(const LaserScan& scan) {
  const std::size_t num_beams = scan.ranges_m.size();
  if (num_beams == 0 || num_beams > kMaxBeams)
    throw DecodeError(fmt::format("scan with {} beams: must be in [1, {}]", num_beams, kMaxBeams));
  const double span_rad = std::abs(scan.angle_increment_rad) * static_cast<double>(num_beams);
  const bool has_angles = std::abs(scan.angle_min_rad) <= kMaxScanAngle_rad && span_rad <= kMaxScanAngle_rad;
  if (!has_angles) throw DecodeError("scan angles exceed one revolution");
  if (!std::isfinite(scan.time_increment_s) || !std::isfinite(scan.scan_time_s))
    throw DecodeError("scan times must be finite");
}

/// Applies REP 117, which many drivers follow only in part.
void tidy_ranges(LaserScan& scan, double no_return_m) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (!(scan.range_max_m > 0.0)) scan.range_max_m = no_return_m;
  if (!(scan.range_min_m >= 0.0)) scan.range_min_m = 0.0;
  scan.range_max_m = std::min(scan.range_max_m, no_return_m);
  for (float& range_m : scan.ranges_m) {
    if (range_m >= static_cast<float>(scan.range_max_m)) range_m = kInfinity;
    else if (range_m > 0.0F && range_m < static_cast<float>(scan.range_min_m)) range_m = -kInfinity;
    else if (range_m <= 0.0F && range_m != -kInfinity) range_m = std::numeric_limits<float>::quiet_NaN();
  }
}

/// Splits a list separated by commas; spaces around the commas are ignored.
std::vector<std::string> topics_of(const std::string& list) {
  std::vector<std::string> topics;
  std::istringstream stream(list);
  for (std::string topic; std::getline(stream >> std::ws, topic, ',');) {
    topic.erase(topic.find_last_not_of(' ') + 1);
    if (!topic.empty()) topics.push_back(topic);
  }
  return topics;
}

/// Removes the leading slash of ROS 1 frame names.
std::string without_slash(const std::string& frame) { return frame.starts_with('/') ? frame.substr(1) : frame; }

bool contains(const std::vector<std::string>& topics, const std::string& topic) {
  return std::find(topics.begin(), topics.end(), topic) != topics.end();
}

}  // namespace

McapScanLog::McapScanLog(const std::filesystem::path& file, const ScanLogOptions& options,
                         std::optional<double> gyro_bias_radps)
    : file_(file),
      options_(options),
      reader_(file, {.topics = {}, .order = McapOrder::kLogTime}),
      scan_topics_(topics_of(options.scan_topic)),
      odometry_topic_(options.odometry_topic),
      imu_topic_(options.imu_topic),
      gyro_(gyro_bias_radps) {
  if (!(options.cloud.min_height_m < options.cloud.max_height_m))
    throw InputError("log.cloud.min_height_m: must be below log.cloud.max_height_m");
  add_static_transforms();
}

/// Adds the first static transform of each frame, wherever it is in the file. Damage is reported by the actual pass.
void McapScanLog::add_static_transforms() {
  McapSelection selection{.topics = {}, .order = McapOrder::kLogTime};
  if (const std::optional<std::set<std::string>> topics = reader_.topics()) {
    std::ranges::copy_if(*topics, std::back_inserter(selection.topics), is_static_topic);
    if (selection.topics.empty()) return;
  }
  McapReader reader(file_, selection);
  std::set<std::string> frames;
  std::optional<double> damaged_at;
  while (true) {
    try {
      const std::optional<McapMessage> message = reader.next();
      if (!message) return;
      if (!is_static_topic(message->channel.topic) || message->channel.type != kRosType<TransformSet>) continue;
      for (const FrameTransform& transform : transforms_of(*message)) {
        if (frames.insert(transform.child).second) frames_.add_static(transform);
      }
    } catch (const DecodeError&) {
    } catch (const InputError&) {
      if (damaged_at == reader.progress()) return;
      damaged_at = reader.progress();
    }
  }
}

std::string McapScanLog::location(const McapMessage& message) const {
  return fmt::format("{}: {} at {:.9f} s: ", file_.string(), message.channel.topic, to_seconds(message.log_time));
}

std::optional<RecordedScan> McapScanLog::next() {
  while (true) {
    if (std::optional<RecordedScan> scan = sorter_.take(is_at_end_)) {
      count_returned(*scan);
      const Pose2 T_fused_body = gyro_.fuse(scan->scan.stamp, scan->T_odom_body);
      if (options_.imu == "on" && !imu_topic_.empty()) {
        scan->T_odom_body = T_fused_body;
        scan->T_begin_end = gyro_.replace_rotation(scan->T_begin_end, scan->scan.stamp, last_beam(scan->scan));
      }
      return scan;
    }
    if (is_at_end_) {
      report_gyro();
      return std::nullopt;
    }
    if (!read_message()) finish();
  }
}

/// Returns the next message. After damage the reader continues with the next record of the file, if it can find one.
std::optional<McapMessage> McapScanLog::next_message() {
  while (true) {
    try {
      return reader_.next();
    } catch (const InputError& error) {  // the message contains the byte offset
      if (damaged_at_ == reader_.progress()) return std::nullopt;
      damaged_at_ = reader_.progress();
      reject_or_skip(options_, "damaged file sections", error.what());
    }
  }
}

bool McapScanLog::read_message() {
  const std::optional<McapMessage> message = next_message();
  if (!message) return false;
  count_read();
  try {
    handle(*message);
  } catch (const DecodeError& error) {
    reject_or_skip(options_, "unreadable messages", location(*message) + error.what());
  }
  return true;
}

void McapScanLog::handle(const McapMessage& message) {
  const std::string &topic = message.channel.topic, &type = message.channel.type;
  if (const std::string& encoding = message.channel.message_encoding;
      encoding != "cdr" && other_encodings_.size() < kMaxNamespaces)
    other_encodings_.insert(on_one_line(encoding));
  if (type == kRosType<LaserScan>) {
    if (scan_topics_.empty() && topic != SensorTraits<RearLaserScan>::kInfo.topic) scan_topics_ = {topic};
    if (contains(scan_topics_, topic)) return add_scan(message);
  } else if (type == kRosType<PointCloud>) {
    if (contains(scan_topics_, topic)) return add_cloud(message);
    cloud_topics_.insert(topic);
  } else if (type == kRosType<OdometryEstimate>) {
    if (odometry_topic_.empty() || topic == odometry_topic_) return add_odometry(message);
  } else if (type == kRosType<Imu> && options_.imu != "off") {
    if (imu_topic_.empty()) imu_topic_ = topic;
    if (topic == imu_topic_) return add_imu(message);
  } else if (type == kRosType<TransformSet>) {
    return add_transforms(message, is_static_topic(topic));
  }
  count_ignored(topic);
}

void McapScanLog::add_scan(const McapMessage& message) {
  expect_cdr(message);
  WaitingScan waiting{.scan = decode<LaserScan>(message.cdr), .frame = header_of(message.cdr).frame};
  add_waiting(std::move(waiting), message);
}

/// Slices a cloud in the frame of the lidar without roll and pitch of its mount, if its mount is known by now.
void McapScanLog::add_cloud(const McapMessage& message) {
  expect_cdr(message);
  const PointCloud cloud = decode_point_cloud(message.cdr);
  WaitingScan waiting{.scan = {}, .frame = header_of(message.cdr).frame};
  const std::optional<Pose3> T_body_lidar = sensor_pose_in_body(waiting.frame, cloud.stamp);
  Eigen::Quaterniond R_level_lidar = Eigen::Quaterniond::Identity();
  if (T_body_lidar)
    R_level_lidar = quaternion_from_yaw(to_pose2(*T_body_lidar).yaw).conjugate() * T_body_lidar->rotation;
  waiting.scan = planar_slice(cloud, R_level_lidar, options_.cloud);
  waiting.is_level = T_body_lidar.has_value();
  add_waiting(std::move(waiting), message);
}

void McapScanLog::add_waiting(WaitingScan waiting, const McapMessage& message) {
  expect_scan(waiting.scan);
  tidy_ranges(waiting.scan, options_.no_return_m);
  waiting_.push_back(std::move(waiting));
  if (waiting_.size() > kMaxWaiting) {
    waiting_.pop_front();
    count_skipped("scans without odometry", location(message) + "no odometry at the stamp of an earlier scan");
  }
  resolve_waiting();
}

void McapScanLog::add_odometry(const McapMessage& message) {
  expect_cdr(message);
  const auto odometry = decode<OdometryEstimate>(message.cdr);
  const OdometryFrames names = odometry_frames_of(message.cdr);
  const bool is_own_opinion = names.frame != frame_id::kWorld && names.frame != frame_id::kMap;
  if (options_.odometry_topic.empty() && !is_own_opinion) {
    if (not_odometry_.size() < kMaxNamespaces) not_odometry_[message.channel.topic] = names.frame;
    return count_ignored(message.channel.topic);
  }
  expect_pose(odometry.T_odom_body, "odometry");
  odometry_topic_ = message.channel.topic;
  if (body_frame_.empty()) body_frame_ = names.child.empty() ? frame_id::kBody : names.child;
  odometry_.add({.stamp = odometry.stamp,
                 .parent = frame_id::kOdom,
                 .child = frame_id::kBody,
                 .T_parent_child = normalized(odometry.T_odom_body)});
  resolve_waiting();
}

void McapScanLog::add_imu(const McapMessage& message) {
  expect_cdr(message);
  const Imu imu = decode<Imu>(message.cdr);
  if (!(imu.angular_velocity_radps.norm() <= kMaxRateRadps)) throw DecodeError("IMU rates not finite or implausible");
  const std::optional<Pose3> T_body_imu = sensor_pose_in_body(header_of(message.cdr).frame, imu.stamp);
  if (!T_body_imu && options_.imu == "on") count_assumed("IMU messages: IMU mounted level (no transform)");
  gyro_.add(imu.stamp,
            T_body_imu ? (T_body_imu->rotation * imu.angular_velocity_radps).z() : imu.angular_velocity_radps.z());
}

void McapScanLog::add_transforms(const McapMessage& message, bool is_static) {
  for (const FrameTransform& transform : transforms_of(message)) {
    is_static ? frames_.add_static(transform) : frames_.add(transform);
    const std::string parent = without_slash(transform.parent);
    const bool is_odom = parent == frame_id::kOdom || parent.ends_with(fmt::format("/{}", frame_id::kOdom));
    if (is_odom && tf_namespaces_.size() < kMaxNamespaces)
      tf_namespaces_.insert(parent.substr(0, parent.size() - std::string_view(frame_id::kOdom).size()));
  }
  resolve_waiting();
}

/// Returns the frames of the robot with the frame of a sensor: those of its namespace, or of the only namespace.
McapScanLog::TfFrames McapScanLog::tf_frames_of(const std::string& frame) const {
  std::string name_space;
  if (tf_namespaces_.size() == 1) name_space = *tf_namespaces_.begin();
  for (const std::string& candidate : tf_namespaces_)
    if (without_slash(frame).starts_with(candidate)) name_space = candidate;  // in order: the longest is the last
  const std::string body = name_space + frame_id::kBody, level = name_space + frame_id::kLevel;
  return {.odom = name_space + frame_id::kOdom,
          .body = !frames_.contains(body) && frames_.contains(level) ? level : body};
}

std::optional<Pose3> McapScanLog::odometry_at(const std::string& frame, Time stamp) const {
  const bool has_topic = !odometry_topic_.empty() && !uses_tf_;
  if (has_topic) return odometry_.find(frame_id::kOdom, frame_id::kBody, stamp);
  const TfFrames names = tf_frames_of(frame);
  return frames_.find(names.odom, names.body, stamp);
}

/// Passes on the scans whose stamps odometry has reached.
void McapScanLog::resolve_waiting() {
  std::deque<WaitingScan> still_waiting;
  for (WaitingScan& waiting : waiting_) {
    const std::optional<Pose3> T_odom_first = odometry_at(waiting.frame, waiting.scan.stamp),
                               T_odom_last = odometry_at(waiting.frame, last_beam(waiting.scan));
    if (T_odom_first && (T_odom_last || is_at_end_))
      add_with_pose(std::move(waiting), to_pose2(*T_odom_first), to_pose2(T_odom_last.value_or(*T_odom_first)));
    else still_waiting.push_back(std::move(waiting));
  }
  waiting_ = std::move(still_waiting);
}

void McapScanLog::add_with_pose(WaitingScan waiting, const Pose2& T_odom_body, const Pose2& T_odom_last) {
  if (odometry_topic_.empty()) uses_tf_ = true;  // from now on use tf only: two sources may differ
  const Pose2 T_body_lidar = to_pose2(mount_of(waiting));
  sort_in(sorter_,
          {.scan = std::move(waiting.scan),
           .T_odom_body = T_odom_body,
           .T_body_lidar = T_body_lidar,
           .T_begin_end = T_odom_body.inverse() * T_odom_last},
          options_, fmt::format("{}: {}", file_.string(), join(scan_topics_, ", ")));
}

std::optional<Pose3> McapScanLog::sensor_pose_in_body(const std::string& frame, Time stamp) const {
  const std::optional<Pose3> T_frame =
      frames_.find(body_frame_.empty() ? tf_frames_of(frame).body : body_frame_, frame, stamp);
  return T_frame ? T_frame : frames_.find(frame_id::kBody, frame, stamp);
}

/// Returns the mount of the lidar. Reverses the beams of a lidar mounted upside down, so that the planar pose is
/// sufficient.
Pose3 McapScanLog::mount_of(WaitingScan& waiting) {
  const std::optional<Pose3> T_body_lidar = sensor_pose_in_body(waiting.frame, waiting.scan.stamp);
  if (!T_body_lidar) {
    count_assumed("scans: lidar at the body origin (no transform)");
    return {};
  }
  const bool is_upside_down = (T_body_lidar->rotation * Eigen::Vector3d::UnitZ()).z() < 0.0;
  if (is_upside_down && !waiting.is_level) {
    waiting.scan.angle_min_rad *= -1.0;
    waiting.scan.angle_increment_rad *= -1.0;
  }
  return *T_body_lidar;
}

void McapScanLog::report_gyro() {
  if (options_.imu != "on" || imu_topic_.empty() || is_gyro_reported_) return;
  is_gyro_reported_ = true;
  const std::optional<double> bias_radps = gyro_.bias_radps();
  std::string how = bias_radps
                        ? fmt::format("bias {:.5f} rad/s from {:.0f} s at rest", *bias_radps, gyro_.stationary_s())
                        : "robot never at rest: zero bias assumed";
  if (bias_radps && gyro_.motion_without_bias_s() > 0.0)
    how += fmt::format(", first {:.0f} s of motion not corrected", gyro_.motion_without_bias_s());
  if (gyro_.uncovered_s() > 0.0)
    how += fmt::format("; {:.1f} s without gyro data use odometry yaw", gyro_.uncovered_s());
  add_found(fmt::format("odometry yaw replaced by the gyro of {}: {} (log.imu)", imu_topic_, how));
}

void McapScanLog::finish() {
  is_at_end_ = true;
  resolve_waiting();
  if (!reader_.is_complete())
    count_skipped("unexpected end of file", file_.string() + ": truncated; read up to the last complete record");
  const std::size_t without_odometry = waiting_.size();
  for (; !waiting_.empty(); waiting_.pop_front()) {
    count_skipped("scans without odometry", fmt::format("{}: no odometry at the stamp of the scan, {:.9f} s",
                                                        file_.string(), to_seconds(waiting_.front().scan.stamp)));
  }
  if (summary().num_scans > 0 || !sorter_.is_empty()) return;
  const std::string selected =
      options_.scan_topic.empty() ? "" : fmt::format(" on {} (log.scan_topic)", options_.scan_topic);
  std::string what = fmt::format("contains no scan{}: must contain sensor_msgs/msg/LaserScan{}", selected,
                                 other_encodings_.empty() ? "" : " in CDR, the encoding of ROS 2");
  if (without_odometry > 0 && !not_odometry_.empty()) {
    const auto& [topic, frame] = *not_odometry_.begin();
    what = fmt::format("the odometry on {} is in the frame {}, not in odom: can be selected: log.odometry_topic={}",
                       topic, frame, topic);
  } else if (without_odometry > 0) {
    what =
        "no odometry overlaps the scans: must contain nav_msgs/msg/Odometry or tf odom -> base_link or base_footprint, "
        "which may have a common namespace";
  }
  const std::string clouds = cloud_topics_.empty() ? ""
                                                   : fmt::format("; point clouds can be selected: log.scan_topic={}",
                                                                 join(cloud_topics_, ","));
  const std::string encodings =
      other_encodings_.empty() ? "" : fmt::format("; other encodings in the log: {}", join(other_encodings_, ", "));
  throw InputError(fmt::format("{}: {} ({}){}{}", file_.string(), what, counted(summary()), clouds, encodings));
}

}  // namespace patrol::io
