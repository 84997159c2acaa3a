#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "render/scene/frame.h"

namespace patrol::render {

/// Chapter of a film that a player can jump to.
struct Chapter {
  double begin_s = 0.0;  ///< film time
  double end_s = 0.0;
  std::string title;
};

/// Writer of MP4 files with H.264 (MPEG-4 part 2 without libx264), or of animated WebP if the name of the file ends
/// with
/// ".webp", without chapters. Equal frames give equal bytes. Writes to a temporary file that is renamed on completion;
/// without `finish` no file remains.
class VideoWriter {
 public:
  /// Throws InputError when the size is odd or the file cannot be written, std::runtime_error when libav fails.
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

/// Whether videos of this name can be joined: MP4.
bool can_join(const std::filesystem::path& file);

/// Joins videos of `VideoWriter` with equal settings into `out`, without encoding again, and adds the chapters. All but
/// the last have `frames_per_video` frames. A single video is moved if it cannot be joined. Throws InputError when a
/// file cannot be read or written.
void join_videos(const std::vector<std::filesystem::path>& videos, int frames_per_video,
                 const std::vector<Chapter>& chapters, const std::filesystem::path& out);

/// Properties of a video file, determined by reading all of its packets.
struct VideoInfo {
  int width = 0;
  int height = 0;
  int num_frames = 0;
  double duration_s = 0.0;
  std::vector<Chapter> chapters;
};
VideoInfo inspect_video(const std::filesystem::path& file);

}  // namespace patrol::render
