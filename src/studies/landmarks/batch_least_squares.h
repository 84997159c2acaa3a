#pragma once

#include <optional>
#include <vector>

#include "studies/landmarks/control_motion.h"
#include "studies/landmarks/range_bearing.h"

namespace patrol::studies {

struct BatchSolution {
  std::vector<Pose2> T_map_body;                          ///< [step], pose after the motion
  std::vector<std::optional<Eigen::Vector2d>> landmarks;  ///< [landmark]
  bool has_converged = false;
};

/// Maximum a posteriori trajectory and landmarks given all controls and observations, including later ones: a lower
/// bound for the average error of any filter. Unknowns are the poses, the control errors and the landmarks; the start
/// pose is the origin of map. Gauss-Newton by Ceres from `guess`, which must contain every observed landmark
/// (std::invalid_argument otherwise). `controls` [step], `observations` [step][observation]; known association.
BatchSolution solve_batch(const ControlMotion& motion, const RangeBearingNoise& noise,
                          const std::vector<Control>& controls,
                          const std::vector<std::vector<RangeBearing>>& observations, const BatchSolution& guess);

}  // namespace patrol::studies
