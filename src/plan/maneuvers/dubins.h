#pragma once

#include <vector>

#include "core/frames.h"

namespace patrol::plan {

/// Part of a path with constant curvature. Curvature: change of the yaw per meter; positive to the left.
struct Arc {
  double curvature_per_m = 0.0;
  double length_m = 0.0;
};

/// Returns the pose after `distance_m` on an arc; negative distances go backward.
Pose2 along_arc(const Pose2& T_map_from, double curvature_per_m, double distance_m);

/// Returns the shortest forward path from the origin to a pose with a bounded turning radius [Dubins57]: at most three
/// arcs, each straight or at the minimum radius.
std::vector<Arc> dubins_path(const Pose2& T_from_to, double radius_m);

double length_m(const std::vector<Arc>& arcs);

}  // namespace patrol::plan
