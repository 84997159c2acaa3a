#pragma once

#include <optional>

#include "core/trajectory.h"

namespace patrol::score {

/// Returns the longest step between two poses of a trajectory in which a pose is interpolated: three median steps, at
/// least 1 s. A longer step is a hole, in which the trajectory is unknown.
Time max_interpolated_step(const Trajectory& trajectory);

/// Returns the interpolated pose at `stamp`; nullopt outside the trajectory and in steps longer than `max_step`.
std::optional<Pose3> pose_outside_holes(const Trajectory& trajectory, Time stamp, Time max_step);

}  // namespace patrol::score
