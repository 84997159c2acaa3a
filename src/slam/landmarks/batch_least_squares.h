#pragma once

#include <optional>
#include <vector>

#include "slam/landmarks/control_motion.h"
#include "slam/landmarks/range_bearing.h"

namespace patrol::slam {

struct BatchSolution {
  std::vector<Pose2> T_map_body;                          ///< [step], after its motion
  std::vector<std::optional<Eigen::Vector2d>> landmarks;  ///< [landmark]
  bool has_converged = false;
};

/// The most probable way and landmarks given all controls and sights, those of the future included: what no filter can beat on the average of a run.
/// Unknowns are the poses, the errors of the controls and the landmarks; start is the map's origin. Gauss-Newton by Ceres from
/// `guess`, which has every landmark that is seen (else std::invalid_argument). `controls` [step], `seen` [step][sight], association known.
BatchSolution solve_batch(const ControlMotion& motion, const RangeBearingNoise& noise, const std::vector<Control>& controls,
                          const std::vector<std::vector<RangeBearing>>& seen, const BatchSolution& guess);

}  // namespace patrol::slam
