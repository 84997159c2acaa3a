#pragma once

#include "core/frames.h"
#include "core/time.h"

namespace patrol {

/// How the robot truly stood at one instant as seen from where it stood at another, as a person found by looking at the scans of both
/// (Kuemmerle et al., "On measuring the accuracy of SLAM algorithms", Autonomous Robots 2009).
struct PoseRelation {
  Time from{};
  Time to{};
  Pose2 T_from_to;
};

}  // namespace patrol
