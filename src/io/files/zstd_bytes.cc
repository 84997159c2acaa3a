#include "io/files/zstd_bytes.h"

#include <stdexcept>

#include <zstd.h>

namespace patrol::io {
namespace {

constexpr int kFastLevel = 1;

}  // namespace

std::string zstd_compressed(std::string_view bytes) {
  std::string frame(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(frame.data(), frame.size(), bytes.data(), bytes.size(), kFastLevel);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  frame.resize(size);
  return frame;
}

std::string zstd_decompressed(std::string_view frame, std::uint64_t size) {
  const unsigned long long content = ZSTD_getFrameContentSize(frame.data(), frame.size());
  if (content != size) throw std::runtime_error("zstd: unexpected size");
  std::string bytes(size, '\0');
  const std::size_t found = ZSTD_decompress(bytes.data(), bytes.size(), frame.data(), frame.size());
  if (ZSTD_isError(found) != 0 || found != size) throw std::runtime_error("zstd: damaged");
  return bytes;
}

}  // namespace patrol::io
