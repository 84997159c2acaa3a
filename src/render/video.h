#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/frame.h"

namespace patrol::render {

/// A part of a film that a player can jump to.
struct Chapter {
  double begin_s = 0.0;  ///< in the film
  double end_s = 0.0;
  std::string title;
};

/// An MP4 file with H.264 in it (MPEG-4 part 2 where libx264 is missing): the same frames give the same
/// bytes. It is written beside its place and takes its name only when it is complete; without `finish`
/// nothing is left behind.
class VideoWriter {
 public:
  /// Throws InputError when the size is odd or the file cannot be written, std::runtime_error when libav
  /// fails.
  VideoWriter(const std::filesystem::path& file, int width, int height, double frames_per_second,
              const std::vector<Chapter>& chapters = {});
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void add(const Frame& frame);
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

/// What is in a video file, by reading it through.
struct VideoInfo {
  int width = 0;
  int height = 0;
  int num_frames = 0;
  double duration_s = 0.0;
  std::vector<Chapter> chapters;
};
VideoInfo inspect_video(const std::filesystem::path& file);

}  // namespace patrol::render
