#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::io {

/// SHA-256 in hexadecimal, as `sha256sum` prints it.
std::string sha256(std::string_view content);
std::string sha256_of_file(const std::filesystem::path& file);

/// Of all files below a folder, by their names and contents; hidden ones and the folder `except` are left out.
std::string sha256_of_folder(const std::filesystem::path& folder, const std::string& except = "");

}  // namespace patrol::io
