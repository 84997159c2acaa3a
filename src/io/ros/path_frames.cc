#include "io/ros/path_frames.h"

#include <algorithm>
#include <utility>

#include "io/ros/ros_codec.h"

namespace patrol::io {

std::vector<std::string> path_frames_of(std::string_view bytes) {
  std::vector<std::string> frames;
  ros::read_cdr(bytes, kRosType<Path>, [&](ros::Reader& reader) {
    const auto read_frame = [&] {
      std::string frame;
      ros::read_head(reader, frame);
      if (std::ranges::find(frames, frame) == frames.end()) frames.push_back(std::move(frame));
    };
    read_frame();
    std::vector<Pose3> poses;
    ros::list(reader, poses, [&](Pose3& pose) {
      read_frame();
      ros::pose3(reader, pose);
    });
  });
  return frames;
}

}  // namespace patrol::io
