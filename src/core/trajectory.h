#pragma once

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/time.h"

namespace patrol {

/// A pose of the body in `map`, `odom` or `world` at an instant.
struct StampedPose {
  Time stamp{};
  Pose3 pose;
};

/// Poses in strictly growing order of time.
using Trajectory = std::vector<StampedPose>;

/// The pose at `stamp`, interpolated between its neighbours; none outside the trajectory.
std::optional<Pose3> pose_at(const Trajectory& trajectory, Time stamp);

/// Length of the path in the ground plane, m.
double planar_length_m(const Trajectory& trajectory);

}  // namespace patrol
