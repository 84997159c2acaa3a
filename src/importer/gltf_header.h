#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace patrol::importer {

/// Returns whether the name of a file is that of a glTF or GLB file.
bool is_gltf(const std::filesystem::path& file);

/// Extensions of a glTF or GLB file that its header lists.
struct GltfHeader {
  std::vector<std::string> used = {};
};

/// Reads the JSON of a glTF or GLB file. Throws InputError with the file if it is not glTF 2, or requires an extension
/// that is not supported, which the message names.
GltfHeader read_gltf_header(const std::filesystem::path& file);

}  // namespace patrol::importer
