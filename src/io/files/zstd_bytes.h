#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace patrol::io {

/// Compresses bytes with zstd at a fast level.
std::string zstd_compressed(std::string_view bytes);

/// Decompresses a zstd frame of `size` bytes. Throws std::runtime_error if it is damaged.
std::string zstd_decompressed(std::string_view frame, std::uint64_t size);

}  // namespace patrol::io
