#include "score/pose/live_trajectory.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace patrol::score {
namespace {

constexpr Time kPeriod = std::chrono::milliseconds(100);
constexpr Time kLookupTimeout = std::chrono::milliseconds(200);

/// Poses received by a time.
std::size_t num_received(const ReceivedPoses& trajectory, Time by) {
  return static_cast<std::size_t>(std::upper_bound(trajectory.received.begin(), trajectory.received.end(), by) -
                                  trajectory.received.begin());
}

/// Index of the newest pose that is not later than `instant` and was received by `deadline`.
std::optional<std::size_t> newest_index(const ReceivedPoses& trajectory, Time instant, Time deadline) {
  const auto end = trajectory.poses.begin() + static_cast<std::ptrdiff_t>(num_received(trajectory, deadline));
  const auto after = std::upper_bound(trajectory.poses.begin(), end, instant,
                                      [](Time time, const StampedPose& entry) { return time < entry.stamp; });
  if (after == trajectory.poses.begin()) return std::nullopt;
  return static_cast<std::size_t>(std::prev(after) - trajectory.poses.begin());
}

/// Odometry at an instant from the messages received by `deadline`. Before the first message it is the first pose.
Pose2 odometry_at(const ReceivedPoses& odometry, Time instant, Time deadline) {
  if (odometry.poses.empty()) return {};
  const std::optional<std::size_t> newest = newest_index(odometry, instant, deadline);
  if (!newest) return to_pose2(odometry.poses.front().pose);
  const StampedPose& before = odometry.poses[*newest];
  if (*newest + 1 >= num_received(odometry, deadline)) return to_pose2(before.pose);
  const StampedPose& after = odometry.poses[*newest + 1];
  const double fraction = to_seconds(instant - before.stamp) / to_seconds(after.stamp - before.stamp);
  return to_pose2(interpolate(before.pose, after.pose, fraction));
}

/// Instants of the common clock in [begin, end]; `end` alone if it contains none.
std::vector<Time> instants_in(Time begin, Time end) {
  std::vector<Time> instants;
  const Time first = kPeriod * ((begin + kPeriod - Time(1)) / kPeriod);
  for (Time instant = first; instant <= end; instant += kPeriod) instants.push_back(instant);
  if (instants.empty() && begin <= end) instants.push_back(end);
  return instants;
}

std::vector<Time> instants_of(const ReceivedPoses& trajectory, Time end) {
  if (trajectory.poses.empty()) return {};
  return instants_in(std::max(trajectory.poses.front().stamp, trajectory.received.front() - kLookupTimeout), end);
}

}  // namespace

Trajectory live_trajectory(const ReceivedPoses& T_map_body, const ReceivedPoses& T_odom_body, Time end) {
  std::vector<Pose2> T_map_odom;
  for (std::size_t i = 0; i < T_map_body.poses.size(); ++i) {
    const StampedPose& estimate = T_map_body.poses[i];
    const Time deadline = std::max(T_map_body.received[i], estimate.stamp + kLookupTimeout);
    T_map_odom.push_back(to_pose2(estimate.pose) * odometry_at(T_odom_body, estimate.stamp, deadline).inverse());
  }
  Trajectory live;
  for (const Time instant : instants_of(T_map_body, end)) {
    const Time deadline = instant + kLookupTimeout;
    const std::optional<std::size_t> newest = newest_index(T_map_body, instant, deadline);
    if (!newest) continue;
    live.push_back({instant, to_pose3(T_map_odom[*newest] * odometry_at(T_odom_body, instant, deadline))});
  }
  return live;
}

Trajectory timely_poses(const ReceivedPoses& trajectory) {
  Trajectory timely;
  for (std::size_t i = 0; i < trajectory.poses.size(); ++i) {
    const StampedPose& pose = trajectory.poses[i];
    if (trajectory.received[i] <= pose.stamp + kLookupTimeout) timely.push_back(pose);
  }
  return timely;
}

Trajectory live_odometry(const ReceivedPoses& T_odom_body, Time end) {
  Trajectory live;
  for (const Time instant : instants_of(T_odom_body, end))
    live.push_back({instant, to_pose3(odometry_at(T_odom_body, instant, instant + kLookupTimeout))});
  return live;
}

}  // namespace patrol::score
