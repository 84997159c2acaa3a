#pragma once

#include <functional>
#include <vector>

#include "core/frames.h"
#include "core/time.h"
#include "score/localizability.h"
#include "score/run_record.h"

namespace patrol::score {

/// Localizability at a position in world, by ground truth.
using LocalizabilityOracle = std::function<Localizability(const Eigen::Vector2d& p_world_m)>;

/// Localizability at the true position of the robot, with the covariance and the confidence of its stack.
struct TrackedLocalizability {
  Time stamp{};
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();
  LocalizabilitySample sample;
};

/// At most two samples a second, at stamps of the stack's estimates.
std::vector<TrackedLocalizability> track_localizability(const RunRecord& record, const Pose2& T_world_map,
                                                        const LocalizabilityOracle& oracle);

LocalizabilityScore score_of(const std::vector<TrackedLocalizability>& track);

}  // namespace patrol::score
