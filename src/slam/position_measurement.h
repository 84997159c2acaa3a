#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::slam {

/// Position of an antenna by satellites, with the odometry at its time.
struct PositionMeasurement {
  Time stamp{};
  Eigen::Vector2d p_survey_antenna = Eigen::Vector2d::Zero();  ///< in survey, whose pose in map is known roughly
  double std_m = 0.0;
  double correlation_time_s = 0.0;  ///< correlation time of the error
  Pose2 T_odom_body = {};
  Eigen::Vector2d p_level_antenna = Eigen::Vector2d::Zero();
};

}  // namespace patrol::slam
