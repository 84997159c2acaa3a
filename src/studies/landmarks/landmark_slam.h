#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "studies/landmarks/control_motion.h"
#include "studies/landmarks/range_bearing.h"

namespace patrol::studies {

struct LandmarkSlamEstimate {
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw in map
  double effective_sample_size = 1.0;
  bool is_resampled = false;
};

/// Interface of online landmark SLAM: estimates the robot pose and the landmarks from controls and range-bearing
/// observations. The origin of map is the start pose.
class LandmarkSlam {
 public:
  virtual ~LandmarkSlam() = default;

  /// Predicts one motion step and updates with the observations taken at its end; `observations` may be empty.
  virtual LandmarkSlamEstimate step(const Control& control, const std::vector<RangeBearing>& observations) = 0;

  /// Landmark positions, [landmark]: by landmark number with known association, otherwise in order of discovery. None:
  /// not observed yet.
  virtual std::vector<std::optional<Eigen::Vector2d>> landmarks() const = 0;
};

}  // namespace patrol::studies
