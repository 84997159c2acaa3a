#include "importer/site/texture_image.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>

#include <png.h>

#include "core/letter_case.h"
#include "io/images/libav_function.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libswscale/swscale.h>
}

namespace patrol::importer {
namespace {

struct FreeContext {
  void operator()(AVCodecContext* context) const { PATROL_LIBAV(avcodec_free_context)(&context); }
};
struct FreePicture {
  void operator()(AVFrame* frame) const { PATROL_LIBAV(av_frame_free)(&frame); }
};
struct FreeImagePacket {
  void operator()(AVPacket* packet) const { PATROL_LIBAV(av_packet_free)(&packet); }
};
struct FreeScaler {
  void operator()(SwsContext* scaler) const { PATROL_LIBAV(sws_freeContext)(scaler); }
};

AVCodecID codec_of(std::string_view bytes, const std::string& extension) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG"sv)) return AV_CODEC_ID_PNG;
  if (bytes.starts_with("\xff\xd8\xff"sv)) return AV_CODEC_ID_MJPEG;
  if (bytes.starts_with("BM"sv)) return AV_CODEC_ID_BMP;
  if (bytes.starts_with("GIF8"sv)) return AV_CODEC_ID_GIF;
  if (bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv)) return AV_CODEC_ID_TIFF;
  if (bytes.starts_with("RIFF"sv) && bytes.substr(0, 12).ends_with("WEBP"sv)) return AV_CODEC_ID_WEBP;
  return to_lower(extension) == ".tga" ? AV_CODEC_ID_TARGA : AV_CODEC_ID_NONE;
}

using Picture = std::unique_ptr<AVFrame, FreePicture>;

Picture decode(std::string_view bytes, AVCodecID id) {
  PATROL_LIBAV(av_log_set_level)(AV_LOG_QUIET);
  const AVCodec* codec = PATROL_LIBAV(avcodec_find_decoder)(id);
  if (codec == nullptr) return nullptr;
  const std::unique_ptr<AVCodecContext, FreeContext> context(PATROL_LIBAV(avcodec_alloc_context3)(codec));
  const std::unique_ptr<AVPacket, FreeImagePacket> packet(PATROL_LIBAV(av_packet_alloc)());
  Picture picture(PATROL_LIBAV(av_frame_alloc)());
  if (!context || !packet || !picture) return nullptr;
  context->thread_count = 1;
  if (PATROL_LIBAV(avcodec_open2)(context.get(), codec, nullptr) < 0) return nullptr;
  if (bytes.size() > 1u << 30 || PATROL_LIBAV(av_new_packet)(packet.get(), static_cast<int>(bytes.size())) < 0)
    return nullptr;
  std::memcpy(packet->data, bytes.data(), bytes.size());
  if (PATROL_LIBAV(avcodec_send_packet)(context.get(), packet.get()) < 0) return nullptr;
  PATROL_LIBAV(avcodec_send_packet)(context.get(), nullptr);
  if (PATROL_LIBAV(avcodec_receive_frame)(context.get(), picture.get()) < 0) return nullptr;
  return picture;
}

/// JPEG's formats of full range have names of their own, which libswscale warns about.
AVPixelFormat plain_format(int format) {
  switch (format) {
    case AV_PIX_FMT_YUVJ420P:
      return AV_PIX_FMT_YUV420P;
    case AV_PIX_FMT_YUVJ422P:
      return AV_PIX_FMT_YUV422P;
    case AV_PIX_FMT_YUVJ444P:
      return AV_PIX_FMT_YUV444P;
    case AV_PIX_FMT_YUVJ440P:
      return AV_PIX_FMT_YUV440P;
    default:
      return static_cast<AVPixelFormat>(format);
  }
}

}  // namespace

std::optional<TextureImage> decode_image(std::string_view bytes, const std::string& extension, int max_side) {
  const AVCodecID id = codec_of(bytes, extension);
  if (id == AV_CODEC_ID_NONE) return std::nullopt;
  const Picture picture = decode(bytes, id);
  if (!picture || picture->width < 1 || picture->height < 1) return std::nullopt;
  const double reduction = std::max(1.0, double(std::max(picture->width, picture->height)) / max_side);
  TextureImage image;
  image.width = std::max(1, static_cast<int>(picture->width / reduction));
  image.height = std::max(1, static_cast<int>(picture->height / reduction));
  const std::unique_ptr<SwsContext, FreeScaler> scaler(PATROL_LIBAV(sws_getContext)(
      picture->width, picture->height, plain_format(picture->format), image.width, image.height, AV_PIX_FMT_RGB24,
      SWS_AREA | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr, nullptr, nullptr));
  if (!scaler) return std::nullopt;
  if (plain_format(picture->format) != picture->format || picture->color_range == AVCOL_RANGE_JPEG) {
    const int* coefficients = PATROL_LIBAV(sws_getCoefficients)(SWS_CS_DEFAULT);
    PATROL_LIBAV(sws_setColorspaceDetails)(scaler.get(), coefficients, 1, coefficients, 1, 0, 1 << 16, 1 << 16);
  }
  // The scaler writes whole vectors beyond the end of a row.
  const int stride = (3 * image.width + 63) / 64 * 64;
  std::vector<std::uint8_t> padded(static_cast<std::size_t>(stride) * static_cast<std::size_t>(image.height) + 64);
  std::array<std::uint8_t*, 4> planes = {padded.data(), nullptr, nullptr, nullptr};
  const std::array<int, 4> strides = {stride, 0, 0, 0};
  if (PATROL_LIBAV(sws_scale)(scaler.get(), picture->data, picture->linesize, 0, picture->height, planes.data(),
                              strides.data()) != image.height)
    return std::nullopt;
  for (int row = 0; row < image.height; ++row) {
    const auto begin = padded.begin() + std::ptrdiff_t{row} * stride;
    image.rgb.insert(image.rgb.end(), begin, begin + 3 * std::ptrdiff_t{image.width});
  }
  return image;
}

std::string encode_png(const TextureImage& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string png(size, '\0');
  if (png_image_write_to_memory(&header, png.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0)
    throw std::runtime_error(std::string("PNG cannot be encoded: ") + header.message);
  png.resize(size);
  return png;
}

Eigen::Vector3d mean_color(const TextureImage& image) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
    sum += Eigen::Vector3d(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]);
  return sum / (255.0 * std::max<double>(1.0, static_cast<double>(image.rgb.size()) / 3.0));
}

}  // namespace patrol::importer
