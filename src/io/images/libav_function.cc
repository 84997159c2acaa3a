#include "io/images/libav_function.h"

#include <array>
#include <stdexcept>

#include <fmt/format.h>

#include "core/shared_library.h"

extern "C" {
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace patrol::io {

void* find_libav_function(const char* name) {
  static const std::array<SharedLibrary, 2> libraries = {
      SharedLibrary(fmt::format("libavformat.so.{}", LIBAVFORMAT_VERSION_MAJOR)),  // needs libavcodec and libavutil
      SharedLibrary(fmt::format("libswscale.so.{}", LIBSWSCALE_VERSION_MAJOR))};
  for (const SharedLibrary& library : libraries) {
    if (!library.is_loaded()) throw std::runtime_error("libav: " + library.error());
    if (void* const found = library.find(name)) return found;
  }
  throw std::runtime_error(fmt::format("libav: has no function {}", name));
}

}  // namespace patrol::io
