#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/logs/scan_log.h"
#include "io/logs/scan_sorter.h"
#include "io/logs/transform_buffer.h"
#include "io/mcap/mcap_reader.h"

namespace patrol::io {

/// Reader of 2D lidar scans from an MCAP log with ROS 2 messages, also the log.mcap of `patrol run`. Scans are
/// sensor_msgs/LaserScan, or slices of sensor_msgs/PointCloud2 if the topic is selected. Odometry is nav_msgs/Odometry
/// or, if the file has none, tf (odom -> base_link), whichever covers a scan first; it is interpolated to the stamp of
/// the scan. The frames of tf may have a common namespace (robot1/odom); without base_link the body is base_footprint.
///
/// - Odometry in the frames `world` and `map` is not an estimate of odometry and is ignored, unless its topic is
///   selected.
/// - The lidar pose is the planar part of /tf_static from the child frame of the odometry (or base_link) to the frame
///   of the scan. The beams of a lidar mounted upside down are reversed. Without a transform the pose is the body
///   origin, which is counted in the summary.
/// - A static transform holds for the whole log, also before its message. Of several for a frame, the first one holds
///   until the message of the next one.
/// - Messages are read by log time (McapOrder::kLogTime).
/// - A scan waits until odometry has passed its stamp. Scans before the first and after the last odometry are skipped
///   and counted.
/// - sensor_msgs/Imu: the rate about the z axis of the body, using /tf_static from base_link to the frame of the IMU.
///   Without a transform the IMU is assumed level, which is counted. With `imu: on` its yaw increments replace those of
///   odometry (gyro_odometry.h); with `auto` they are only monitored.
/// - A truncated file is read up to the truncation.
class McapScanLog : public ScanLog {
 public:
  /// Opens a log. `gyro_bias_radps`: gyro bias from an earlier pass over the file.
  McapScanLog(const std::filesystem::path& file, const ScanLogOptions& options,
              std::optional<double> gyro_bias_radps = {});

  std::optional<RecordedScan> next() override;
  double progress() const override { return is_at_end_ ? 1.0 : reader_.progress(); }
  const GyroOdometry* gyro() const override { return imu_topic_.empty() ? nullptr : &gyro_; }

 private:
  struct WaitingScan {
    LaserScan scan;
    std::string frame;
    bool is_level = false;  ///< angles are about the vertical axis, not about that of the lidar
  };
  /// Names of the frames of odometry in tf.
  struct TfFrames {
    std::string odom, body;
  };

  void add_static_transforms();
  std::optional<McapMessage> next_message();
  bool read_message();
  void handle(const McapMessage& message);
  void add_scan(const McapMessage& message);
  void add_cloud(const McapMessage& message);
  void add_waiting(WaitingScan waiting, const McapMessage& message);
  void add_odometry(const McapMessage& message);
  void add_imu(const McapMessage& message);
  void add_transforms(const McapMessage& message, bool is_static);
  void resolve_waiting();
  void add_with_pose(WaitingScan waiting, const Pose2& T_odom_body, const Pose2& T_odom_last);
  TfFrames tf_frames_of(const std::string& frame) const;
  std::optional<Pose3> odometry_at(const std::string& frame, Time stamp) const;
  std::optional<Pose3> sensor_pose_in_body(const std::string& frame, Time stamp) const;
  Pose3 mount_of(WaitingScan& waiting);
  void report_gyro();
  void finish();
  std::string location(const McapMessage& message) const;

  std::filesystem::path file_;
  ScanLogOptions options_;
  McapReader reader_;
  std::vector<std::string> scan_topics_;
  std::set<std::string> cloud_topics_;     ///< topics of clouds that are not selected
  std::set<std::string> other_encodings_;  ///< encodings of messages that are not CDR
  std::string odometry_topic_, imu_topic_, body_frame_;
  TransformBuffer odometry_;  ///< odometry topic only
  TransformBuffer frames_;    ///< transforms of /tf and /tf_static
  GyroOdometry gyro_;
  std::set<std::string> tf_namespaces_;  ///< namespaces of the odom frames in tf: "robot1/"; "": no namespace
  std::map<std::string, std::string> not_odometry_;  ///< frame of ignored odometry, by topic
  bool uses_tf_ = false;
  std::deque<WaitingScan> waiting_;
  ScanSorter sorter_;
  std::optional<double> damaged_at_;  ///< progress at the damage
  bool is_at_end_ = false, is_gyro_reported_ = false;
};

}  // namespace patrol::io
