#pragma once

#include <filesystem>
#include <vector>

#include "render/video/chapter.h"
#include "render/video/libav.h"

namespace patrol::render {

/// Video file with one stream of encoded packets: MP4, or animated WebP. Written beside its final name and renamed by
/// `finish`; without it no file remains.
class VideoFile {
 public:
  /// Throws InputError when the name of the file ends with neither ".mp4" nor ".webp".
  explicit VideoFile(std::filesystem::path file);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  bool is_webp() const { return file_.extension() == ".webp"; }
  /// Whether the codec's parameters are stored once, in the header of the file.
  bool needs_global_header() const { return (context_->oformat->flags & AVFMT_GLOBALHEADER) != 0; }
  /// Stream whose parameters the caller sets before `write_header`.
  AVStream& stream() { return *stream_; }

  /// Creates the file. A WebP file has no chapters. Throws InputError when it cannot be written.
  void write_header(const std::vector<Chapter>& chapters);
  /// Writes a packet whose times are in units of `time_base`.
  void write(AVPacket& packet, AVRational time_base);
  /// Completes the file and gives it its name.
  void finish();

 private:
  std::filesystem::path file_;
  std::filesystem::path temporary_;
  AVFormatContext* context_ = nullptr;
  AVStream* stream_ = nullptr;
};

}  // namespace patrol::render
