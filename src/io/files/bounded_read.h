#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace patrol::io {

/// Size limit of a file that is read whole (`load_text` in io/files/atomic_file.h).
inline constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 30;

/// Returns the whole content of a regular file of at most `max_bytes`. Throws InputError when the file is missing, is a
/// folder, a device or a pipe, is larger, or cannot be read.
std::string load_text(const std::filesystem::path& file, std::uintmax_t max_bytes);

}  // namespace patrol::io
