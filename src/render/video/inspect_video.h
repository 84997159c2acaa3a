#pragma once

#include <filesystem>
#include <vector>

#include "render/video/chapter.h"

namespace patrol::render {

/// Properties of a video file, determined by reading all of its packets.
struct VideoInfo {
  int width = 0;
  int height = 0;
  int num_frames = 0;
  double duration_s = 0.0;
  std::vector<Chapter> chapters;
};

/// Throws InputError when the file cannot be read as a video.
VideoInfo inspect_video(const std::filesystem::path& file);

}  // namespace patrol::render
