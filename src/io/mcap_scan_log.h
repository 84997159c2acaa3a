#pragma once

#include <deque>
#include <optional>
#include <string>

#include "io/frame_tree.h"
#include "io/mcap_reader.h"
#include "io/scan_log.h"
#include "io/scan_sorter.h"

namespace patrol::io {

/// A log in MCAP with ROS 2 messages: sensor_msgs/LaserScan, and odometry from nav_msgs/Odometry or, where the file has none, from tf
/// (odom -> base_link; whichever can place a scan first), interpolated to the scan's stamp. Also the log.mcap of `patrol run`.
///
/// - Odometry in the frames `world` and `map` is not the robot's own opinion and is passed over, unless its topic was asked for.
/// - The lidar's place is the planar part of /tf_static from the odometry's child frame (or base_link) to the scan's frame; a lidar
///   that hangs upside down is turned round. Without such a transform it is the body's origin, which is counted.
/// - A scan waits for odometry beyond its stamp. Those that find none, before the first and after the last, are skipped and counted.
/// - sensor_msgs/Imu: the rate about the body's z axis, by /tf_static from base_link to the IMU's frame; without such a transform the IMU is level, which is
///   counted. With `imu: on` its turns take the place of odometry's (gyro_odometry.h); `auto` only watches it.
/// - A file that was cut off is read up to the cut.
class McapScanLog : public ScanLog {
 public:
  /// `gyro_bias_radps`: as an earlier look at the file found it.
  McapScanLog(const std::filesystem::path& file, const ScanLogOptions& options, std::optional<double> gyro_bias_radps = {});

  std::optional<RecordedScan> next() override;
  double progress() const override { return is_at_end_ ? 1.0 : reader_.progress(); }
  const GyroOdometry* gyro() const override { return imu_topic_.empty() ? nullptr : &gyro_; }

 private:
  struct WaitingScan {
    LaserScan scan;
    std::string frame;
  };

  std::optional<McapMessage> next_message();
  bool read_message();
  void handle(const McapMessage& message);
  void add_scan(const McapMessage& message);
  void add_odometry(const McapMessage& message);
  void add_imu(const McapMessage& message);
  void add_transforms(const McapMessage& message, bool is_static);
  void resolve_waiting();
  void add_placed(WaitingScan waiting, const Pose2& T_odom_body, const Pose2& T_odom_last);
  std::optional<Pose3> odometry_at(Time stamp) const;
  std::optional<Pose3> place_in_body(const std::string& frame, Time stamp) const;
  Pose3 mount_of(WaitingScan& waiting);
  void note_gyro();
  void finish();
  std::string place(const McapMessage& message) const;

  std::filesystem::path file_;
  ScanLogOptions options_;
  McapReader reader_;
  std::string scan_topic_, odometry_topic_, imu_topic_, body_frame_;
  FrameTree odometry_;  ///< of the odometry topic alone
  FrameTree frames_;    ///< of tf
  GyroOdometry gyro_;
  bool uses_tf_ = false;
  std::deque<WaitingScan> waiting_;
  ScanSorter sorter_;
  std::optional<double> damage_at_;  ///< how far the file was read then
  bool is_at_end_ = false, is_gyro_noted_ = false;
};

}  // namespace patrol::io
