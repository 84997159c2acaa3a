#include "render/video/video_file.h"

#include <cmath>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace patrol::render {
namespace {

using libav::checked;
using libav::not_null;

constexpr AVRational kMillisecond{1, 1000};

/// Allocates the chapters with libav's allocator, because libav frees them with the container.
void add_chapters(AVFormatContext& container, const std::vector<Chapter>& chapters) {
  if (chapters.empty()) return;
  container.chapters = not_null(static_cast<AVChapter**>(PATROL_LIBAV(av_calloc)(chapters.size(), sizeof(AVChapter*))),
                                "memory for chapters");
  for (const Chapter& chapter : chapters) {
    AVChapter* mark =
        not_null(static_cast<AVChapter*>(PATROL_LIBAV(av_mallocz)(sizeof(AVChapter))), "memory for a chapter");
    container.chapters[container.nb_chapters++] = mark;
    mark->id = container.nb_chapters;
    mark->time_base = kMillisecond;
    mark->start = std::llround(1e3 * chapter.begin_s);
    mark->end = std::llround(1e3 * chapter.end_s);
    PATROL_LIBAV(av_dict_set)(&mark->metadata, "title", chapter.title.c_str(), 0);
  }
}

}  // namespace

VideoFile::VideoFile(std::filesystem::path file) : file_(std::move(file)), temporary_(file_.string() + ".part") {
  if (!is_webp() && file_.extension() != ".mp4")
    throw InputError(file_.string() + ": the name of a video must end with .mp4 or .webp");
  checked(
      PATROL_LIBAV(avformat_alloc_output_context2)(&context_, nullptr, is_webp() ? "webp" : "mp4", temporary_.c_str()),
      "cannot create the writer");
  context_->flags |= AVFMT_FLAG_BITEXACT;
  stream_ = not_null(PATROL_LIBAV(avformat_new_stream)(context_, nullptr), "stream");
}

VideoFile::~VideoFile() {
  if (context_ != nullptr) {
    PATROL_LIBAV(avio_closep)(&context_->pb);
    PATROL_LIBAV(avformat_free_context)(context_);
  }
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void VideoFile::write_header(const std::vector<Chapter>& chapters) {
  if (PATROL_LIBAV(avio_open)(&context_->pb, temporary_.c_str(), AVIO_FLAG_WRITE) < 0)
    throw InputError(file_.string() + ": cannot be written");
  AVDictionary* options = nullptr;
  if (is_webp()) {
    PATROL_LIBAV(av_dict_set)(&options, "loop", "0", 0);  // without end
  } else {
    add_chapters(*context_, chapters);
    PATROL_LIBAV(av_dict_set)(&options, "movflags", "+faststart", 0);
  }
  const int code = PATROL_LIBAV(avformat_write_header)(context_, &options);
  PATROL_LIBAV(av_dict_free)(&options);
  checked(code, "file header");
}

void VideoFile::write(AVPacket& packet, AVRational time_base) {
  PATROL_LIBAV(av_packet_rescale_ts)(&packet, time_base, stream_->time_base);
  packet.stream_index = stream_->index;
  checked(PATROL_LIBAV(av_interleaved_write_frame)(context_, &packet), "cannot write a frame");
}

void VideoFile::finish() {
  checked(PATROL_LIBAV(av_write_trailer)(context_), "file trailer");
  checked(PATROL_LIBAV(avio_closep)(&context_->pb), "cannot close the file");
  std::error_code error;
  std::filesystem::rename(temporary_, file_, error);
  if (error) throw InputError(file_.string() + ": cannot be written: " + error.message());
}

}  // namespace patrol::render
