#include "score/pose/interpolation_limit.h"

#include <algorithm>
#include <vector>

#include "core/upper_median.h"

namespace patrol::score {
namespace {

constexpr double kMinLimit_s = 1.0, kLimitInMedians = 3.0;

}  // namespace

Time max_interpolated_step(const Trajectory& trajectory) {
  if (trajectory.size() < 2) return from_seconds(kMinLimit_s);
  std::vector<double> steps_s;
  steps_s.reserve(trajectory.size() - 1);
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    steps_s.push_back(to_seconds(trajectory[i].stamp - trajectory[i - 1].stamp));
  return from_seconds(std::max(kMinLimit_s, kLimitInMedians * upper_median(steps_s)));
}

std::optional<Pose3> pose_outside_holes(const Trajectory& trajectory, Time stamp, Time max_step) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp,
                                      [](const StampedPose& entry, Time t) { return entry.stamp < t; });
  const bool is_between = after != trajectory.begin() && after != trajectory.end() && after->stamp != stamp;
  if (is_between && after->stamp - (after - 1)->stamp > max_step) return std::nullopt;
  return pose_at(trajectory, stamp);
}

}  // namespace patrol::score
