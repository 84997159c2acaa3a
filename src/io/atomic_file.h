#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::io {

/// Writes the whole file or nothing: into a file beside it that then takes its name. Throws InputError when the place
/// cannot be written to.
void save_text(const std::filesystem::path& file, std::string_view text);

/// The whole file. Throws InputError when there is none, or it cannot be read.
std::string load_text(const std::filesystem::path& file);

}  // namespace patrol::io
