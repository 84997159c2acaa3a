#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/stack/stack_settings.h"
#include "core/robot_description.h"
#include "core/trajectory.h"
#include "localize/body_estimator.h"
#include "localize/scan_leveler.h"

namespace patrol::app {

/// The quadruped's mapping alone, fed from a log: what the robot would have believed, had it mapped otherwise. Nobody steers by it.
class LogMapper {
 public:
  LogMapper(const StackSettings& settings, const RobotDescription& robot, std::uint64_t seed);

  /// Throws InputError when the log is damaged, or made no map.
  void map(const std::filesystem::path& log_mcap);

  const Trajectory& T_map_body() const { return T_map_body_; }  ///< at every scan
  OccupancyGrid map() { return slam_->map(); }
  double seconds() const { return seconds_; }  ///< of processor time that SLAM took

 private:
  void handle(const LaserScan& scan);

  localize::BodyEstimator odometry_;
  localize::ScanLeveler leveler_;
  std::unique_ptr<slam::Mapper> slam_;
  Time settle_;
  std::optional<Time> first_odometry_;
  Trajectory T_map_body_;
  double seconds_ = 0.0;
};

}  // namespace patrol::app
