#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace patrol::io {

/// Returns the SHA-256 digest in hexadecimal, as printed by `sha256sum`.
std::string sha256(std::string_view content);
std::string sha256_of_file(const std::filesystem::path& file);

/// Returns the digest of all files in a folder and its subfolders, by name and content. Hidden files and the folder
/// `except` are skipped.
std::string sha256_of_folder(const std::filesystem::path& folder, const std::string& except = "");

}  // namespace patrol::io
