#include "core/trajectory.h"

#include <algorithm>

namespace patrol {

std::optional<Pose3> pose_at(const Trajectory& trajectory, Time stamp) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& entry, Time t) { return entry.stamp < t; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  const double fraction = to_seconds(stamp - before->stamp) / to_seconds(after->stamp - before->stamp);
  return interpolate(before->pose, after->pose, fraction);
}

double planar_length_m(const Trajectory& trajectory) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length_m += (trajectory[i].pose.position - trajectory[i - 1].pose.position).head<2>().norm();
  }
  return length_m;
}

}  // namespace patrol
