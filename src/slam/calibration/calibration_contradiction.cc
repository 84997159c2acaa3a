#include "slam/calibration/calibration_contradiction.h"

#include <cmath>

#include <fmt/format.h>

namespace patrol::slam {
namespace {

constexpr double kTurnRad = 0.1;  ///< segments with smaller turns tell no direction
constexpr int kMinTurns = 10;
constexpr double kMostly = 0.5;

}  // namespace

std::string calibration_contradiction(const std::vector<MotionSegment>& segments, const CalibrationResult& result,
                                      int min_segments) {
  int num_turns = 0, num_reversed = 0;
  for (const MotionSegment& segment : segments) {
    const double lidar_rad = segment.lidar().yaw, odometry_rad = segment.odometry.yaw;
    if (std::abs(lidar_rad) < kTurnRad || std::abs(odometry_rad) < kTurnRad) continue;
    ++num_turns;
    if (lidar_rad * odometry_rad < 0.0) ++num_reversed;
  }
  if (num_turns >= kMinTurns && num_reversed > kMostly * num_turns) {
    return fmt::format(
        "odometry and lidar turn in opposite directions in {} of {} turning segments: the order of the beams or the "
        "yaw of odometry must be reversed",
        num_reversed, num_turns);
  }
  if (result.num_segments - result.num_rejected < min_segments) {
    return fmt::format(
        "{} of {} segments rejected: odometry and lidar contradict each other: both must be in meters and radians",
        result.num_rejected, result.num_segments);
  }
  return {};
}

}  // namespace patrol::slam
