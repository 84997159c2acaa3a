#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/time.h"
#include "core/trajectory.h"
#include "io/ros/ros_messages.h"

namespace patrol::io {

/// Transform buffer for /tf and /tf_static, as in tf2. Each frame has one parent; moving transforms are kept for
/// `kBufferLength`.
class TransformBuffer {
 public:
  static constexpr Time kBufferLength = std::chrono::seconds(10);  ///< buffer length of moving transforms
  static constexpr std::size_t kMaxPoses = 2'000;                  ///< maximum number of buffered transforms per frame
  /// Maximum number of frames; more than any robot has, further frames are ignored.
  static constexpr std::size_t kMaxFrames = 1'000;

  void add_static(const FrameTransform& transform);
  /// Adds a moving transform. A transform that is not newer than the latest one of its frame is dropped. If the parent
  /// of the frame changes, the earlier transforms are discarded.
  void add(const FrameTransform& transform);

  /// Returns whether a transform has the frame as its parent or child.
  bool contains(const std::string& frame) const;

  /// Returns the pose of `child` in `parent` at an instant, over any chain of frames; nullopt if the chain is not
  /// connected at this instant.
  std::optional<Pose3> find(const std::string& parent, const std::string& child, Time stamp) const;

 private:
  struct Link {
    std::string parent;
    bool is_static = false;
    std::deque<StampedPose> T_parent_child;  ///< poses by increasing stamp; one entry if static
  };
  struct Ancestor {
    std::string frame;
    Pose3 T_frame_child;
  };
  /// Returns the frame itself and its ancestors, as far as known at the instant.
  std::vector<Ancestor> ancestors(const std::string& frame, Time stamp) const;
  Link* find_or_add_link(const FrameTransform& transform);

  std::map<std::string, Link> links_;  ///< links by child frame
};

}  // namespace patrol::io
