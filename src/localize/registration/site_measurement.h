#pragma once

#include <variant>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/time.h"
#include "core/uwb.h"

namespace patrol::localize {

/// Position of the GNSS antenna in `site`.
struct AntennaPosition {
  Eigen::Vector2d p_level_antenna = Eigen::Vector2d::Zero();  ///< lever arm, m
  Eigen::Vector2d p_site_antenna = Eigen::Vector2d::Zero();   ///< measured position, m
  double std_m = 0.0;                                         ///< standard deviation along each axis
};

/// UWB range to a surveyed anchor.
struct AnchorRange {
  UwbAnchor anchor_in_site;
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();  ///< raised as by uwb_antenna_in_level, m
  double range_m = 0.0;                                       ///< reading, with the bias of the calibration
  double std_m = 0.0;
};

/// Pose of the body in `site`, e.g. from the detection of the surveyed dock.
struct SurveyedPose {
  Pose2 T_site_body;
  double position_std_m = 0.0;
  double yaw_std_rad = 0.0;
};

/// Measurement that relates a pose in `map` to the survey.
///
/// The errors of one source are a first-order Gauss-Markov process with the correlation time: `correlation_time_s` of 0
/// means independent errors. Different sources are independent.
struct SiteMeasurement {
  Time stamp{};
  int source = 0;
  double correlation_time_s = 0.0;
  Pose2 T_map_body;  ///< pose of the level body at the stamp, by the present map
  std::variant<AntennaPosition, AnchorRange, SurveyedPose> content;
};

}  // namespace patrol::localize
