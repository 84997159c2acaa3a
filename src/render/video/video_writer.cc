#include "render/video/video_writer.h"

#include <cstdint>
#include <stdexcept>

#include <fmt/format.h>

extern "C" {
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include "core/error.h"
#include "render/video/libav.h"
#include "render/video/video_file.h"

namespace patrol::render {
namespace {

using libav::checked;
using libav::not_null;

/// Declares BT.709 for all sizes; without a declaration players choose the color space by the size.
void use_bt709(AVCodecContext& codec) {
  codec.colorspace = AVCOL_SPC_BT709;
  codec.color_primaries = AVCOL_PRI_BT709;
  codec.color_trc = AVCOL_TRC_BT709;
  codec.color_range = AVCOL_RANGE_MPEG;
}

void use_bt709(SwsContext* scaler) {
  constexpr int kFullRange = 1, kVideoRange = 0, kUnchanged = 1 << 16;
  PATROL_LIBAV(sws_setColorspaceDetails)
  (scaler, PATROL_LIBAV(sws_getCoefficients)(SWS_CS_DEFAULT), kFullRange,
   PATROL_LIBAV(sws_getCoefficients)(SWS_CS_ITU709), kVideoRange, 0, kUnchanged, kUnchanged);
}

}  // namespace

struct VideoWriter::Encoder {
  explicit Encoder(const std::filesystem::path& target) : file(target) {}
  ~Encoder() {
    PATROL_LIBAV(av_frame_free)(&picture);
    PATROL_LIBAV(sws_freeContext)(scaler);
    PATROL_LIBAV(avcodec_free_context)(&codec);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  void open_codec(int width, int height, double frames_per_second);
  void set_quality() const;
  void open_file(const std::vector<Chapter>& chapters);
  void prepare_picture(int width, int height);
  void encode(const AVFrame* frame);

  VideoFile file;
  AVCodecContext* codec = nullptr;
  SwsContext* scaler = nullptr;
  AVFrame* picture = nullptr;
  libav::Packet packet = libav::make_packet();
  std::int64_t num_frames = 0;
};

void VideoWriter::Encoder::open_codec(int width, int height, double frames_per_second) {
  const AVCodec* kind = PATROL_LIBAV(avcodec_find_encoder_by_name)(file.is_webp() ? "libwebp_anim" : "libx264");
  if (kind == nullptr && !file.is_webp()) kind = PATROL_LIBAV(avcodec_find_encoder)(AV_CODEC_ID_MPEG4);
  not_null(kind, "encoder");
  codec = not_null(PATROL_LIBAV(avcodec_alloc_context3)(kind), "encoder");
  codec->width = width;
  codec->height = height;
  codec->framerate = PATROL_LIBAV(av_d2q)(frames_per_second, 100000);
  codec->time_base = av_inv_q(codec->framerate);
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  use_bt709(*codec);
  codec->gop_size = 60;
  codec->thread_count = 1;  // the output of rate control depends on the number of threads
  PATROL_LIBAV(av_log_set_level)(AV_LOG_ERROR);
  codec->flags |= AV_CODEC_FLAG_BITEXACT;
  if (file.needs_global_header()) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  set_quality();
  checked(PATROL_LIBAV(avcodec_open2)(codec, kind, nullptr), "cannot start the encoder");
}

void VideoWriter::Encoder::set_quality() const {
  if (file.is_webp()) {
    PATROL_LIBAV(av_opt_set_double)(codec->priv_data, "quality", 60.0, 0);
  } else if (codec->codec_id == AV_CODEC_ID_H264) {
    PATROL_LIBAV(av_opt_set)(codec->priv_data, "preset", "veryfast", 0);
    PATROL_LIBAV(av_opt_set)(codec->priv_data, "crf", "23", 0);
    PATROL_LIBAV(av_opt_set)
    (codec->priv_data, "mbtree", "0", 0);  // x264 164 reads memory there that it has not written
  } else {
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = 4 * FF_QP2LAMBDA;
  }
}

void VideoWriter::Encoder::open_file(const std::vector<Chapter>& chapters) {
  file.stream().time_base = codec->time_base;
  file.stream().avg_frame_rate = codec->framerate;
  checked(PATROL_LIBAV(avcodec_parameters_from_context)(file.stream().codecpar, codec), "stream parameters");
  file.write_header(chapters);
}

void VideoWriter::Encoder::prepare_picture(int width, int height) {
  scaler =
      not_null(PATROL_LIBAV(sws_getContext)(width, height, AV_PIX_FMT_RGB24, width, height, AV_PIX_FMT_YUV420P,
                                            SWS_POINT | SWS_ACCURATE_RND | SWS_BITEXACT, nullptr, nullptr, nullptr),
               "color conversion");
  use_bt709(scaler);
  picture = not_null(PATROL_LIBAV(av_frame_alloc)(), "picture");
  picture->format = AV_PIX_FMT_YUV420P;
  picture->width = width;
  picture->height = height;
  checked(PATROL_LIBAV(av_frame_get_buffer)(picture, 0), "cannot allocate a picture");
}

void VideoWriter::Encoder::encode(const AVFrame* frame) {
  checked(PATROL_LIBAV(avcodec_send_frame)(codec, frame), "frame rejected by the encoder");
  for (;;) {
    const int code = PATROL_LIBAV(avcodec_receive_packet)(codec, packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
    checked(code, "cannot encode a frame");
    packet->duration = 1;
    file.write(*packet, codec->time_base);
  }
}

VideoWriter::VideoWriter(const std::filesystem::path& file, int width, int height, double frames_per_second,
                         const std::vector<Chapter>& chapters)
    : encoder_(std::make_unique<Encoder>(file)) {
  if (width < 2 || height < 2 || width % 2 != 0 || height % 2 != 0) {
    throw InputError(fmt::format("size = {}x{}: a video's width and height must be even", width, height));
  }
  encoder_->open_codec(width, height, frames_per_second);
  encoder_->open_file(chapters);
  encoder_->prepare_picture(width, height);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Frame& frame) {
  Encoder& encoder = *encoder_;
  if (frame.width() != encoder.codec->width || frame.height() != encoder.codec->height) {
    throw std::runtime_error("video: frame size differs from the video size");
  }
  checked(PATROL_LIBAV(av_frame_make_writable)(encoder.picture), "cannot allocate a picture");
  const std::uint8_t* rows[1] = {frame.bytes()};
  const int stride[1] = {3 * frame.width()};
  PATROL_LIBAV(sws_scale)
  (encoder.scaler, rows, stride, 0, frame.height(), encoder.picture->data, encoder.picture->linesize);
  encoder.picture->pts = encoder.num_frames++;
  encoder.encode(encoder.picture);
}

void VideoWriter::finish() {
  encoder_->encode(nullptr);
  encoder_->file.finish();
}

}  // namespace patrol::render
