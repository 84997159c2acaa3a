#include "render/video/libav.h"

#include <string>

#include "core/error.h"

namespace patrol::render::libav {
namespace {

std::string message(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  PATROL_LIBAV(av_strerror)(code, text, sizeof text);
  return text;
}

}  // namespace

int checked(int code, const char* doing) {
  if (code < 0) throw std::runtime_error(fmt::format("video: {}: {}", doing, message(code)));
  return code;
}

Packet make_packet() { return Packet(not_null(PATROL_LIBAV(av_packet_alloc)(), "packet")); }

InputVideo open_input(const std::filesystem::path& file) {
  AVFormatContext* opened = nullptr;
  if (PATROL_LIBAV(avformat_open_input)(&opened, file.c_str(), nullptr, nullptr) < 0)
    throw InputError(file.string() + ": cannot read as a video");
  InputVideo video(opened);
  checked(PATROL_LIBAV(avformat_find_stream_info)(opened, nullptr), "no stream");
  return video;
}

}  // namespace patrol::render::libav
