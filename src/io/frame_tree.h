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
#include "io/ros_messages.h"

namespace patrol::io {

/// How frames lie to each other, as /tf and /tf_static tell it: each has one parent. What moves is remembered for a while only.
class FrameTree {
 public:
  static constexpr Time kMemory = std::chrono::seconds(10);  ///< of what moves
  static constexpr std::size_t kMostPoses = 2'000;           ///< likewise, of one frame
  static constexpr std::size_t kMostFrames = 1'000;          ///< further ones are not noted: no robot has as many

  void add_static(const FrameTransform& transform);
  /// What is not newer than what is known of the frame is dropped, and so is all that was known of it when it changes its parent.
  void add(const FrameTransform& transform);

  /// Where `child` is seen from `parent` at an instant, over whatever lies between them; none when that is not known, or not for
  /// this instant.
  std::optional<Pose3> find(const std::string& parent, const std::string& child, Time stamp) const;

 private:
  struct Link {
    std::string parent;
    bool is_static = false;
    std::deque<StampedPose> T_parent_child;  ///< by growing stamp; one if static
  };
  struct Ancestor {
    std::string frame;
    Pose3 T_frame_child;
  };
  /// The frame itself first, then as far up as is known at the instant.
  std::vector<Ancestor> ancestors(const std::string& frame, Time stamp) const;
  Link* link_of(const FrameTransform& transform);

  std::map<std::string, Link> links_;  ///< by child
};

}  // namespace patrol::io
