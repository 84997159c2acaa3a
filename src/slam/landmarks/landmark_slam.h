#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "slam/landmarks/control_motion.h"
#include "slam/landmarks/range_bearing.h"

namespace patrol::slam {

struct LandmarkSlamEstimate {
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in map
  double effective_sample_size = 1.0;
  bool is_resampled = false;
};

/// A robot's way and the landmarks beside it, from what it was told to do and what it saw, as it goes. The map's origin is where it starts.
class LandmarkSlam {
 public:
  virtual ~LandmarkSlam() = default;

  /// One step of motion, then what is seen from where it ends; nothing seen is an observation too many steps have.
  virtual LandmarkSlamEstimate step(const Control& control, const std::vector<RangeBearing>& seen) = 0;

  /// [landmark]; by its number where the association is known, else in the order in which they were found. None: not seen.
  virtual std::vector<std::optional<Eigen::Vector2d>> landmarks() const = 0;
};

}  // namespace patrol::slam
