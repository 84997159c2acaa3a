#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::io {

/// Writes a file atomically: into a temporary file in the same folder, which is then renamed. Throws InputError if the
/// folder is not writable, and OutputError (output_error.h) if the disk is full.
void save_text(const std::filesystem::path& file, std::string_view text);

/// Returns the whole content of a file. Throws InputError if the file is missing or cannot be read.
std::string load_text(const std::filesystem::path& file);

}  // namespace patrol::io
