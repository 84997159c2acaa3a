#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/mapping/log_mapping.h"
#include "app/run/stack_port.h"
#include "io/ros/ros_messages.h"

namespace patrol::app {

/// The built-in SLAM as a stack that is fed with a recorded log. It publishes the pose of every scan, and at the end
/// the corrected trajectory and the map.
class MappingStack final : public StackPort {
 public:
  /// `mounts`: transforms of the sensors, with that of the lidar. Throws InputError if a setting breaks its rule.
  MappingStack(const LogMappingSettings& settings, const io::TransformSet& mounts);

  void deliver(link::DeliveredMessage message) override;
  void begin_turn(Time now) override { turn_ = now; }
  StackAnswer end_turn() override;
  std::vector<PublishedMessage> finish(Time now) override;
  bool records_turns() const override { return false; }
  std::map<std::string, double> seconds_by_stage() const override { return {{"stack", seconds_}}; }

 private:
  void map_scan(LaserScan scan);

  LogMappingSettings settings_;
  std::unique_ptr<slam::Mapper> mapper_;
  slam::CalibratedScans calibrated_;
  Pose2 T_body_lidar_;
  std::optional<Pose2> T_odom_first_, T_odom_last_;  ///< odometry at the first and the last beam of the next scan
  std::vector<Time> stamps_;
  Time turn_{};                              ///< last turn
  std::vector<PublishedMessage> published_;  ///< messages published since the last turn
  double seconds_ = 0.0;                     ///< CPU time
};

}  // namespace patrol::app
