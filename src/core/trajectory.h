#pragma once

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/time.h"

namespace patrol {

/// Pose of the body in `map`, `odom` or `world` at an instant.
struct StampedPose {
  Time stamp{};
  Pose3 pose;
};

/// Poses with strictly increasing stamps.
using Trajectory = std::vector<StampedPose>;

/// Returns the interpolated pose at `stamp`; nullopt outside the trajectory.
std::optional<Pose3> pose_at(const Trajectory& trajectory, Time stamp);

/// Returns the length of the path in the ground plane, m.
double planar_length_m(const Trajectory& trajectory);

}  // namespace patrol
