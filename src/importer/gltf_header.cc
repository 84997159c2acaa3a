#include "importer/gltf_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/letter_case.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

bool is_supported(std::string_view extension) {
  return extension.starts_with("KHR_materials_") || extension == "KHR_lights_punctual";
}

/// Returns the JSON chunk of a GLB file [glTF 2.0, section 4.4].
std::string json_of_glb(const std::filesystem::path& file, const std::string& bytes) {
  std::array<std::uint32_t, 5> head{};  // magic, version, length, length of the first chunk, its type
  constexpr std::uint32_t kJson = 0x4E4F534A;
  if (bytes.size() >= sizeof head) std::memcpy(head.data(), bytes.data(), sizeof head);
  if (head[1] != 2 || head[4] != kJson || head[3] > bytes.size() - sizeof head)
    throw InputError(file.string() + ": GLB header: must be of version 2 with a JSON chunk");
  return bytes.substr(sizeof head, head[3]);
}

}  // namespace

bool is_gltf(const std::filesystem::path& file) {
  const std::string extension = to_lower(file.extension().string());
  return extension == ".gltf" || extension == ".glb";
}

GltfHeader read_gltf_header(const std::filesystem::path& file) {
  const std::string bytes = io::load_text(file);
  const std::string text = bytes.starts_with("glTF") ? json_of_glb(file, bytes) : bytes;
  GltfHeader header;
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    const std::string version = json.at("asset").at("version").get<std::string>();
    if (!version.starts_with("2."))
      throw InputError(fmt::format("{}: asset.version: \"{}\": must be 2.x", file.string(), io::on_one_line(version)));
    for (const std::string& extension : json.value("extensionsRequired", std::vector<std::string>())) {
      if (!is_supported(extension))
        throw InputError(fmt::format("{}: extensionsRequired: {}: this extension is not supported", file.string(),
                                     io::on_one_line(extension)));
    }
    header.used = json.value("extensionsUsed", std::vector<std::string>());
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: not a glTF file: {}", file.string(), io::on_one_line(error.what())));
  }
  return header;
}

}  // namespace patrol::importer
