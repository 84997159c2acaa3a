#include "render/video.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include "core/error.h"

namespace patrol::render {
namespace {

std::string libav_message(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

int checked(int code, const char* doing) {
  if (code < 0) throw std::runtime_error(fmt::format("video: {}: {}", doing, libav_message(code)));
  return code;
}

template <typename Pointer>
Pointer* not_null(Pointer* pointer, const char* what) {
  if (pointer == nullptr) throw std::runtime_error(fmt::format("video: libav: cannot allocate {}", what));
  return pointer;
}

constexpr AVRational kMillisecond{1, 1000};

/// Allocates the chapters with libav's allocator, because libav frees them with the container.
void add_chapters(AVFormatContext& container, const std::vector<Chapter>& chapters) {
  if (chapters.empty()) return;
  container.chapters =
      not_null(static_cast<AVChapter**>(av_calloc(chapters.size(), sizeof(AVChapter*))), "memory for chapters");
  for (const Chapter& chapter : chapters) {
    AVChapter* mark = not_null(static_cast<AVChapter*>(av_mallocz(sizeof(AVChapter))), "memory for a chapter");
    container.chapters[container.nb_chapters++] = mark;
    mark->id = container.nb_chapters;
    mark->time_base = kMillisecond;
    mark->start = std::llround(1e3 * chapter.begin_s);
    mark->end = std::llround(1e3 * chapter.end_s);
    av_dict_set(&mark->metadata, "title", chapter.title.c_str(), 0);
  }
}

/// Declares BT.709 for all sizes; without a declaration players choose the color space by the size.
void use_bt709(AVCodecContext& codec) {
  codec.colorspace = AVCOL_SPC_BT709;
  codec.color_primaries = AVCOL_PRI_BT709;
  codec.color_trc = AVCOL_TRC_BT709;
  codec.color_range = AVCOL_RANGE_MPEG;
}

void use_bt709(SwsContext* scaler) {
  constexpr int kFullRange = 1, kVideoRange = 0, kUnchanged = 1 << 16;
  sws_setColorspaceDetails(scaler, sws_getCoefficients(SWS_CS_DEFAULT), kFullRange, sws_getCoefficients(SWS_CS_ITU709),
                           kVideoRange, 0, kUnchanged, kUnchanged);
}

}  // namespace

struct VideoWriter::Encoder {
  explicit Encoder(std::filesystem::path target) : file(std::move(target)), temporary(file.string() + ".part") {}
  ~Encoder() {
    av_packet_free(&packet);
    av_frame_free(&picture);
    sws_freeContext(scaler);
    avcodec_free_context(&codec);
    if (container != nullptr) {
      avio_closep(&container->pb);
      avformat_free_context(container);
    }
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  void open_codec(int width, int height, double frames_per_second);
  void set_quality() const;
  void open_container(int width, int height, const std::vector<Chapter>& chapters);
  void encode(const AVFrame* frame) const;

  bool is_webp() const { return file.extension() == ".webp"; }

  std::filesystem::path file;
  std::filesystem::path temporary;
  AVFormatContext* container = nullptr;
  AVCodecContext* codec = nullptr;
  AVStream* stream = nullptr;
  SwsContext* scaler = nullptr;
  AVFrame* picture = nullptr;
  AVPacket* packet = nullptr;
  std::int64_t num_frames = 0;
};

void VideoWriter::Encoder::open_codec(int width, int height, double frames_per_second) {
  checked(avformat_alloc_output_context2(&container, nullptr, is_webp() ? "webp" : "mp4", temporary.c_str()),
          "cannot create the writer");
  container->flags |= AVFMT_FLAG_BITEXACT;
  const AVCodec* kind = avcodec_find_encoder_by_name(is_webp() ? "libwebp_anim" : "libx264");
  if (kind == nullptr && !is_webp()) kind = avcodec_find_encoder(AV_CODEC_ID_MPEG4);
  not_null(kind, "encoder");
  codec = not_null(avcodec_alloc_context3(kind), "encoder");
  codec->width = width;
  codec->height = height;
  codec->framerate = av_d2q(frames_per_second, 100000);
  codec->time_base = av_inv_q(codec->framerate);
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  use_bt709(*codec);
  codec->gop_size = 60;
  codec->thread_count = 1;  // the output of rate control depends on the number of threads
  av_log_set_level(AV_LOG_ERROR);
  codec->flags |= AV_CODEC_FLAG_BITEXACT;
  if ((container->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  set_quality();
  checked(avcodec_open2(codec, kind, nullptr), "cannot start the encoder");
}

void VideoWriter::Encoder::set_quality() const {
  if (is_webp()) {
    av_opt_set_double(codec->priv_data, "quality", 60.0, 0);
  } else if (codec->codec_id == AV_CODEC_ID_H264) {
    av_opt_set(codec->priv_data, "preset", "veryfast", 0);
    av_opt_set(codec->priv_data, "crf", "23", 0);
  } else {
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = 4 * FF_QP2LAMBDA;
  }
}

void VideoWriter::Encoder::open_container(int width, int height, const std::vector<Chapter>& chapters) {
  stream = not_null(avformat_new_stream(container, nullptr), "stream");
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  checked(avcodec_parameters_from_context(stream->codecpar, codec), "stream parameters");
  if (avio_open(&container->pb, temporary.c_str(), AVIO_FLAG_WRITE) < 0) {
    throw InputError(file.string() + ": cannot be written");
  }
  AVDictionary* options = nullptr;
  if (is_webp()) {
    av_dict_set(&options, "loop", "0", 0);  // without end
  } else {
    add_chapters(*container, chapters);
    av_dict_set(&options, "movflags", "+faststart", 0);
  }
  const int code = avformat_write_header(container, &options);
  av_dict_free(&options);
  checked(code, "file header");

  scaler = not_null(sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, AV_PIX_FMT_YUV420P,
                                   SWS_POINT | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr, nullptr),
                    "color conversion");
  use_bt709(scaler);
  picture = not_null(av_frame_alloc(), "picture");
  picture->format = AV_PIX_FMT_YUV420P;
  picture->width = width;
  picture->height = height;
  checked(av_frame_get_buffer(picture, 0), "cannot allocate a picture");
  packet = not_null(av_packet_alloc(), "packet");
}

void VideoWriter::Encoder::encode(const AVFrame* frame) const {
  checked(avcodec_send_frame(codec, frame), "frame rejected by the encoder");
  for (;;) {
    const int code = avcodec_receive_packet(codec, packet);
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
    checked(code, "cannot encode a frame");
    packet->duration = 1;
    av_packet_rescale_ts(packet, codec->time_base, stream->time_base);
    packet->stream_index = stream->index;
    checked(av_interleaved_write_frame(container, packet), "cannot write a frame");
  }
}

VideoWriter::VideoWriter(const std::filesystem::path& file, int width, int height, double frames_per_second,
                         const std::vector<Chapter>& chapters)
    : encoder_(std::make_unique<Encoder>(file)) {
  if (width < 2 || height < 2 || width % 2 != 0 || height % 2 != 0) {
    throw InputError(fmt::format("size = {}x{}: a video's width and height must be even", width, height));
  }
  encoder_->open_codec(width, height, frames_per_second);
  encoder_->open_container(width, height, chapters);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Frame& frame) {
  Encoder& encoder = *encoder_;
  if (frame.width() != encoder.codec->width || frame.height() != encoder.codec->height) {
    throw std::runtime_error("video: frame size differs from the video size");
  }
  checked(av_frame_make_writable(encoder.picture), "cannot allocate a picture");
  const std::uint8_t* rows[1] = {frame.bytes()};
  const int stride[1] = {3 * frame.width()};
  sws_scale(encoder.scaler, rows, stride, 0, frame.height(), encoder.picture->data, encoder.picture->linesize);
  encoder.picture->pts = encoder.num_frames++;
  encoder.encode(encoder.picture);
}

void VideoWriter::finish() {
  Encoder& encoder = *encoder_;
  encoder.encode(nullptr);
  checked(av_write_trailer(encoder.container), "file trailer");
  checked(avio_closep(&encoder.container->pb), "cannot close the file");
  std::error_code error;
  std::filesystem::rename(encoder.temporary, encoder.file, error);
  if (error) throw InputError(encoder.file.string() + ": cannot be written: " + error.message());
}

bool can_join(const std::filesystem::path& file) { return file.extension() != ".webp"; }

namespace {

struct CloseInput {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};
using InputVideo = std::unique_ptr<AVFormatContext, CloseInput>;

InputVideo open_input(const std::filesystem::path& file) {
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, file.c_str(), nullptr, nullptr) < 0)
    throw InputError(file.string() + ": cannot read as a video");
  InputVideo video(opened);
  checked(avformat_find_stream_info(opened, nullptr), "no stream");
  return video;
}

struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
using Packet = std::unique_ptr<AVPacket, FreePacket>;

/// Video file without an encoder: packets are copied into it.
class JoinedVideo {
 public:
  JoinedVideo(std::filesystem::path file, const AVStream& like, const std::vector<Chapter>& chapters)
      : file_(std::move(file)), temporary_(file_.string() + ".part") {
    checked(avformat_alloc_output_context2(&container_, nullptr, "mp4", temporary_.c_str()),
            "cannot create the writer");
    container_->flags |= AVFMT_FLAG_BITEXACT;
    stream_ = not_null(avformat_new_stream(container_, nullptr), "stream");
    checked(avcodec_parameters_copy(stream_->codecpar, like.codecpar), "stream parameters");
    stream_->codecpar->codec_tag = 0;
    stream_->time_base = like.time_base;
    stream_->avg_frame_rate = like.avg_frame_rate;
    if (avio_open(&container_->pb, temporary_.c_str(), AVIO_FLAG_WRITE) < 0)
      throw InputError(file_.string() + ": cannot be written");
    add_chapters(*container_, chapters);
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "+faststart", 0);
    const int code = avformat_write_header(container_, &options);
    av_dict_free(&options);
    checked(code, "file header");
  }
  ~JoinedVideo() {
    if (container_ != nullptr) {
      avio_closep(&container_->pb);
      avformat_free_context(container_);
    }
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
  JoinedVideo(const JoinedVideo&) = delete;
  JoinedVideo& operator=(const JoinedVideo&) = delete;

  /// Appends the packets of a video, `num_frames` frames after the beginning.
  void append(AVFormatContext& video, int num_frames) {
    const AVStream& from = *video.streams[0];
    const std::int64_t shift = av_rescale_q(num_frames, av_inv_q(stream_->avg_frame_rate), from.time_base);
    const Packet packet(not_null(av_packet_alloc(), "packet"));
    while (av_read_frame(&video, packet.get()) >= 0) {
      packet->pts += shift;
      packet->dts += shift;
      packet->stream_index = 0;
      packet->pos = -1;
      av_packet_rescale_ts(packet.get(), from.time_base, stream_->time_base);
      checked(av_interleaved_write_frame(container_, packet.get()), "cannot write a frame");
    }
  }

  void finish() {
    checked(av_write_trailer(container_), "file trailer");
    checked(avio_closep(&container_->pb), "cannot close the file");
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) throw InputError(file_.string() + ": cannot be written: " + error.message());
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path temporary_;
  AVFormatContext* container_ = nullptr;
  AVStream* stream_ = nullptr;
};

}  // namespace

void join_videos(const std::vector<std::filesystem::path>& videos, int frames_per_video,
                 const std::vector<Chapter>& chapters, const std::filesystem::path& out) {
  if (!can_join(out)) {
    std::error_code error;
    std::filesystem::rename(videos.at(0), out, error);
    if (error) throw InputError(out.string() + ": cannot be written: " + error.message());
    return;
  }
  const InputVideo first = open_input(videos.at(0));
  JoinedVideo joined(out, *first->streams[0], chapters);
  for (std::size_t i = 0; i < videos.size(); ++i)
    joined.append(*open_input(videos[i]), static_cast<int>(i) * frames_per_video);
  joined.finish();
}

VideoInfo inspect_video(const std::filesystem::path& file) {
  const InputVideo container = open_input(file);
  AVFormatContext* opened = container.get();
  const int index = checked(av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0), "no picture");
  const AVStream* stream = opened->streams[index];
  VideoInfo info{.width = stream->codecpar->width,
                 .height = stream->codecpar->height,
                 .duration_s = static_cast<double>(opened->duration) / AV_TIME_BASE,
                 .chapters = {}};
  for (const AVChapter* mark : std::span(opened->chapters, opened->nb_chapters)) {
    const AVDictionaryEntry* title = av_dict_get(mark->metadata, "title", nullptr, 0);
    const double unit_s = av_q2d(mark->time_base);
    info.chapters.push_back({.begin_s = unit_s * static_cast<double>(mark->start),
                             .end_s = unit_s * static_cast<double>(mark->end),
                             .title = title != nullptr ? title->value : ""});
  }
  const Packet packet(not_null(av_packet_alloc(), "packet"));
  while (av_read_frame(opened, packet.get()) >= 0) {
    if (packet->stream_index == index) ++info.num_frames;
    av_packet_unref(packet.get());
  }
  return info;
}

}  // namespace patrol::render
