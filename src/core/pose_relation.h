#pragma once

#include "core/frames.h"
#include "core/time.h"

namespace patrol {

/// Reference pose of the robot at one instant relative to its pose at another instant. Determined by manual scan
/// alignment [Kuemmerle09].
struct PoseRelation {
  Time from{};
  Time to{};
  Pose2 T_from_to;
};

}  // namespace patrol
