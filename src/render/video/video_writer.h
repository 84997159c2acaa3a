#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "render/scene/frame.h"
#include "render/video/chapter.h"

namespace patrol::render {

/// Writer of MP4 files with H.264 (MPEG-4 part 2 without libx264), or of animated WebP if the name of the file ends
/// with ".webp", without chapters. Equal frames give equal bytes. Writes to a temporary file that is renamed on
/// completion; without `finish` no file remains.
class VideoWriter {
 public:
  /// Throws InputError when the name ends with neither ".mp4" nor ".webp", the size is odd or the file cannot be
  /// written, std::runtime_error when libav fails.
  VideoWriter(const std::filesystem::path& file, int width, int height, double frames_per_second,
              const std::vector<Chapter>& chapters = {});
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// Encodes the next frame. Throws std::runtime_error when the frame's size differs from the video's.
  void add(const Frame& frame);
  /// Completes the file and gives it its name.
  void finish();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace patrol::render
