#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "io/images/libav_function.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

/// Helpers for libav, which the files of this folder have in common.
namespace patrol::render::libav {

/// Returns `code`. Throws std::runtime_error with libav's message if it is negative.
int checked(int code, const char* doing);

/// Returns `pointer`. Throws std::runtime_error if it is null.
template <typename Pointer>
Pointer* not_null(Pointer* pointer, const char* name) {
  if (pointer == nullptr) throw std::runtime_error(fmt::format("video: libav: cannot allocate {}", name));
  return pointer;
}

struct FreePacket {
  void operator()(AVPacket* packet) const { PATROL_LIBAV(av_packet_free)(&packet); }
};
using Packet = std::unique_ptr<AVPacket, FreePacket>;
Packet make_packet();

struct CloseInput {
  void operator()(AVFormatContext* context) const { PATROL_LIBAV(avformat_close_input)(&context); }
};
using InputVideo = std::unique_ptr<AVFormatContext, CloseInput>;

/// Opens a video file for reading. Throws InputError if it cannot be read as a video.
InputVideo open_input(const std::filesystem::path& file);

}  // namespace patrol::render::libav
