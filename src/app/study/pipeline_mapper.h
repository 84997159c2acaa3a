#pragma once

#include <cstdint>
#include <filesystem>

#include "core/robot_description.h"
#include "core/trajectory.h"
#include "stack/localization/pose_pipeline.h"

namespace patrol::app {

/// Map and poses that the stack's pose pipeline computes from a recorded log, with other settings than those of the
/// run. They have no influence on the robot.
class PipelineMapper {
 public:
  PipelineMapper(const stack::StackSettings& settings, const RobotDescription& robot, std::uint64_t seed);

  /// Processes a log. Throws InputError if it is damaged or yields no map.
  void map(const std::filesystem::path& log_mcap);

  const Trajectory& T_map_body() const { return T_map_body_; }  ///< pose at every scan
  OccupancyGrid map() { return pipeline_.map(); }
  double seconds() const { return seconds_; }  ///< processor time of SLAM

 private:
  void handle(const LaserScan& raw);

  stack::PosePipeline pipeline_;
  stack::StackOutput output_;
  Trajectory T_map_body_;
  double seconds_ = 0.0;
};

}  // namespace patrol::app
