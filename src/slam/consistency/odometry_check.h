#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::slam {

/// Contradiction between odometry and the mapped path.
enum class OdometryFault {
  kConstant,  ///< odometry does not change while the robot moves
  kReversed,  ///< odometry moves or turns in the opposite direction
  kJumping,   ///< odometry moves from one scan to the next by much more than the robot
  kSlipping,  ///< any other difference of more than half of the motion, after correction of the scales
};
inline constexpr std::array<std::string_view, 4> kOdometryFaultNames = {"constant", "reversed", "jumping", "slipping"};

/// Consecutive segments of the path with the same fault.
struct FaultyOdometry {
  OdometryFault fault{};
  std::size_t first_scan = 0, last_scan = 0;
  double distance_m = 0.0;                          ///< distance along the mapped path
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();  ///< position of the first scan
};

/// Estimate with its standard deviation.
struct OdometryScale {
  double value = 1.0, std = 0.0;
};

/// Agreement of wheel odometry with a mapped path.
struct OdometryHealth {
  int num_segments = 0, num_faulty = 0;
  double distance_m = 0.0;             ///< along the mapped path
  std::vector<FaultyOdometry> faulty;  ///< largest distance first
  // None: the path does not determine it.
  std::optional<OdometryScale> distance;  ///< true distance / odometry distance
  std::optional<OdometryScale> turn;      ///< true yaw change / odometry yaw change
  std::optional<OdometryScale> steering;  ///< unmeasured yaw change to the left per meter; rad per m
  double delay_s = 0.0;                   ///< delay of odometry; negative: it is ahead of the scans; 0: none found
  std::size_t num_gaps = 0;               ///< intervals between scans of more than 1 s and 5 times the median
  double max_gap_s = 0.0;                 ///< duration of the largest gap
  std::size_t max_gap_scan = 0;           ///< scan before the largest gap

  double faulty_ratio() const { return num_segments == 0 ? 0.0 : static_cast<double>(num_faulty) / num_segments; }
};

/// Compares odometry with the mapped path in segments of 0.5 m or 0.35 rad. Where scans do not determine the position,
/// the path follows odometry and hides its errors. All arguments: [scan].
OdometryHealth check_odometry(const std::vector<Pose2>& T_odom_body, const std::vector<Pose2>& T_map_body,
                              const std::vector<Time>& stamps);

}  // namespace patrol::slam
