#include "io/logs/transform_buffer.h"

#include <algorithm>

namespace patrol::io {
namespace {

constexpr std::size_t kMaxTreeDepth = 64;  ///< maximum depth of the tree; also ends cyclic chains

/// Removes the leading slash of ROS 1 frame names; tf2 does not use it.
std::string plain(const std::string& frame) { return frame.starts_with('/') ? frame.substr(1) : frame; }

std::optional<Pose3> pose_at_stamp(const std::deque<StampedPose>& poses, Time stamp) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const StampedPose& entry, Time t) { return entry.stamp < t; });
  if (after == poses.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == poses.begin()) return std::nullopt;
  const StampedPose& before = *(after - 1);
  return interpolate(before.pose, after->pose,
                     to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp));
}

}  // namespace

TransformBuffer::Link* TransformBuffer::find_or_add_link(const FrameTransform& transform) {
  const std::string child = plain(transform.child), parent = plain(transform.parent);
  const auto known = links_.find(child);
  if (known == links_.end() && links_.size() >= kMaxFrames) return nullptr;
  Link& link = links_[child];
  if (link.parent != parent) link = {.parent = parent, .T_parent_child = {}};
  return &link;
}

void TransformBuffer::add_static(const FrameTransform& transform) {
  if (Link* const link = find_or_add_link(transform)) {
    link->is_static = true;
    link->T_parent_child = {{transform.stamp, transform.T_parent_child}};
  }
}

void TransformBuffer::add(const FrameTransform& transform) {
  Link* const link = find_or_add_link(transform);
  if (!link) return;
  std::deque<StampedPose>& poses = link->T_parent_child;
  if (link->is_static) poses.clear();
  link->is_static = false;
  if (!poses.empty() && transform.stamp <= poses.back().stamp) return;
  poses.push_back({transform.stamp, transform.T_parent_child});
  while (poses.size() > kMaxPoses || transform.stamp - poses.front().stamp > kBufferLength) poses.pop_front();
}

bool TransformBuffer::contains(const std::string& frame) const {
  const std::string name = plain(frame);
  return links_.contains(name) ||
         std::ranges::any_of(links_, [&](const auto& link) { return link.second.parent == name; });
}

std::vector<TransformBuffer::Ancestor> TransformBuffer::ancestors(const std::string& frame, Time stamp) const {
  std::vector<Ancestor> line = {{plain(frame), {}}};
  while (line.size() < kMaxTreeDepth) {
    const auto link = links_.find(line.back().frame);
    if (link == links_.end()) break;
    const auto& poses = link->second.T_parent_child;
    const std::optional<Pose3> T_parent_child =
        link->second.is_static ? poses.front().pose : pose_at_stamp(poses, stamp);
    if (!T_parent_child) break;
    line.push_back({link->second.parent, *T_parent_child * line.back().T_frame_child});
  }
  return line;
}

std::optional<Pose3> TransformBuffer::find(const std::string& parent, const std::string& child, Time stamp) const {
  const std::vector<Ancestor> of_parent = ancestors(parent, stamp), of_child = ancestors(child, stamp);
  for (const Ancestor& above : of_child) {
    const auto common = std::find_if(of_parent.begin(), of_parent.end(),
                                     [&](const Ancestor& other) { return other.frame == above.frame; });
    if (common != of_parent.end()) return common->T_frame_child.inverse() * above.T_frame_child;
  }
  return std::nullopt;
}

}  // namespace patrol::io
