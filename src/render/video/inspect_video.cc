#include "render/video/inspect_video.h"

#include <span>

#include "render/video/libav.h"

namespace patrol::render {

VideoInfo inspect_video(const std::filesystem::path& file) {
  const libav::InputVideo container = libav::open_input(file);
  AVFormatContext* opened = container.get();
  const int index =
      libav::checked(PATROL_LIBAV(av_find_best_stream)(opened, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0), "no picture");
  const AVStream* stream = opened->streams[index];
  VideoInfo info{.width = stream->codecpar->width,
                 .height = stream->codecpar->height,
                 .duration_s = static_cast<double>(opened->duration) / AV_TIME_BASE,
                 .chapters = {}};
  for (const AVChapter* mark : std::span(opened->chapters, opened->nb_chapters)) {
    const AVDictionaryEntry* title = PATROL_LIBAV(av_dict_get)(mark->metadata, "title", nullptr, 0);
    const double unit_s = av_q2d(mark->time_base);
    info.chapters.push_back({.begin_s = unit_s * static_cast<double>(mark->start),
                             .end_s = unit_s * static_cast<double>(mark->end),
                             .title = title != nullptr ? title->value : ""});
  }
  const libav::Packet packet = libav::make_packet();
  while (PATROL_LIBAV(av_read_frame)(opened, packet.get()) >= 0) {
    if (packet->stream_index == index) ++info.num_frames;
    PATROL_LIBAV(av_packet_unref)(packet.get());
  }
  return info;
}

}  // namespace patrol::render
