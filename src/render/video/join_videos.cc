#include "render/video/join_videos.h"

#include <cstdint>
#include <system_error>

#include "core/error.h"
#include "render/video/libav.h"
#include "render/video/video_file.h"

namespace patrol::render {
namespace {

/// Gives an empty file the stream parameters of a video.
void copy_parameters(const AVStream& from, AVStream& to) {
  libav::checked(PATROL_LIBAV(avcodec_parameters_copy)(to.codecpar, from.codecpar), "stream parameters");
  to.codecpar->codec_tag = 0;
  to.time_base = from.time_base;
  to.avg_frame_rate = from.avg_frame_rate;
}

/// Appends the packets of `video` to `file`, `num_frames` frames after the beginning.
void append(AVFormatContext& video, int num_frames, VideoFile& file) {
  const AVStream& from = *video.streams[0];
  const std::int64_t shift =
      PATROL_LIBAV(av_rescale_q)(num_frames, av_inv_q(file.stream().avg_frame_rate), from.time_base);
  const libav::Packet packet = libav::make_packet();
  while (PATROL_LIBAV(av_read_frame)(&video, packet.get()) >= 0) {
    packet->pts += shift;
    packet->dts += shift;
    packet->pos = -1;
    file.write(*packet, from.time_base);
  }
}

}  // namespace

bool can_join(const std::filesystem::path& file) { return file.extension() != ".webp"; }

void join_videos(const std::vector<std::filesystem::path>& videos, int frames_per_video,
                 const std::vector<Chapter>& chapters, const std::filesystem::path& out) {
  if (!can_join(out)) {
    std::error_code error;
    std::filesystem::rename(videos.at(0), out, error);
    if (error) throw InputError(out.string() + ": cannot be written: " + error.message());
    return;
  }
  VideoFile joined(out);
  copy_parameters(*libav::open_input(videos.at(0))->streams[0], joined.stream());
  joined.write_header(chapters);
  for (std::size_t i = 0; i < videos.size(); ++i)
    append(*libav::open_input(videos[i]), static_cast<int>(i) * frames_per_video, joined);
  joined.finish();
}

}  // namespace patrol::render
