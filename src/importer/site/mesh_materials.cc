#include "importer/site/mesh_materials.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include <assimp/material.h>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/gltf_header.h"
#include "importer/site/texture_image.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

/// Encodes linear light as sRGB [IEC 61966-2-1].
double to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Returns a path of a material's file: with slashes, and without the percent encoding of a URI.
std::string plain_path(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  std::string plain;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool is_code = path[i] == '%' && i + 2 < path.size() &&
                         std::isxdigit(static_cast<unsigned char>(path[i + 1])) &&
                         std::isxdigit(static_cast<unsigned char>(path[i + 2]));
    if (is_code) plain += static_cast<char>(std::stoi(path.substr(i + 1, 2), nullptr, 16)), i += 2;
    else plain += path[i];
  }
  return plain;
}

std::string texture_path(const aiMaterial& material) {
  aiString path;
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    if (material.GetTexture(type, 0, &path) == AI_SUCCESS && path.length > 0) return path.C_Str();
  }
  return {};
}

std::string name_of_material(const aiMaterial& material) {
  aiString name;
  material.Get(AI_MATKEY_NAME, name);
  return io::on_one_line(name.C_Str());
}

std::optional<TextureImage> decode_embedded(const aiTexture& texture) {
  if (texture.mHeight == 0) {
    const std::string_view bytes(reinterpret_cast<const char*>(texture.pcData), texture.mWidth);
    return decode_image(bytes, std::string(".") + texture.achFormatHint);
  }
  TextureImage image{.width = static_cast<int>(texture.mWidth), .height = static_cast<int>(texture.mHeight)};
  for (std::size_t i = 0; i < std::size_t{texture.mWidth} * texture.mHeight; ++i) {
    const aiTexel& texel = texture.pcData[i];
    image.rgb.insert(image.rgb.end(), {texel.r, texel.g, texel.b});
  }
  return image;
}

}  // namespace

MeshMaterials::MeshMaterials(const aiScene& source, const std::filesystem::path& file, std::string prefix,
                             MeshScene& scene)
    : source_(source), file_(file), prefix_(std::move(prefix)), scene_(scene) {
  is_linear_ = is_gltf(file);
}

bool MeshMaterials::has_color(unsigned index) const {
  const aiMaterial& material = *source_.mMaterials[index];
  aiColor4D color;
  return !texture_path(material).empty() || (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == AI_SUCCESS &&
                                             name_of_material(material) != AI_DEFAULT_MATERIAL_NAME);
}

bool MeshMaterials::is_gray(unsigned index) const {
  const aiMaterial& material = *source_.mMaterials[index];
  aiColor4D color(1.0F, 1.0F, 1.0F, 1.0F);
  if (material.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  const auto [low, high] = std::minmax({color.r, color.g, color.b});
  return texture_path(material).empty() && high - low < 1e-3F;
}

std::string MeshMaterials::unique_name(const std::string& wanted) {
  std::string name = prefix_ + (wanted.empty() ? "material" : wanted);
  for (int i = 2; !names_.insert(name).second; ++i) name = fmt::format("{}{} {}", prefix_, wanted, i);
  return name;
}

std::size_t MeshMaterials::plain(const std::string& name, const Eigen::Vector4d& rgba) {
  const auto [found, is_new] = plain_.try_emplace(name, scene_.materials.size());
  if (is_new) scene_.materials.push_back({.name = unique_name(name), .rgba = rgba});
  return found->second;
}

MeshMaterials::Texture MeshMaterials::load(const std::string& path) {
  std::optional<TextureImage> image;
  std::string why = "cannot be decoded";
  if (const aiTexture* embedded = source_.GetEmbeddedTexture(path.c_str())) {
    image = decode_embedded(*embedded);
  } else {
    const std::filesystem::path file = file_.parent_path() / plain_path(path);
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) image = decode_image(io::load_text(file), file.extension());
    else why = "file not found";
  }
  if (!image) {
    scene_.rows.push_back(
        {"texture " + io::on_one_line(path), why + ": the color of the material is used", "the file"});
    return {};
  }
  Texture texture{.file = fmt::format("{}{}.png", prefix_, scene_.textures.size() + 1), .mean = mean_color(*image)};
  std::replace(texture.file.begin(), texture.file.end(), '/', '_');
  scene_.textures.push_back({.path = "textures/" + texture.file, .content = encode_png(*image)});
  return texture;
}

const MeshMaterials::Texture& MeshMaterials::texture_of(const std::string& path) {
  if (const auto found = textures_.find(path); found != textures_.end()) return found->second;
  return textures_.emplace(path, load(path)).first->second;
}

std::size_t MeshMaterials::of(unsigned index, bool has_coordinates) {
  const auto [found, is_new] = index_of_.try_emplace({index, has_coordinates}, scene_.materials.size());
  if (!is_new) return found->second;
  const aiMaterial& source = *source_.mMaterials[index];
  SiteMaterial material;
  aiColor4D color(0.7F, 0.7F, 0.7F, 1.0F);
  if (has_color(index)) {
    if (source.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS) source.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  }
  for (int k = 0; k < 3; ++k) {
    const double value = std::clamp(double{color[static_cast<unsigned>(k)]}, 0.0, 1.0);
    material.rgba[k] = is_linear_ ? to_srgb(value) : value;
  }
  float opacity = 1.0F;
  aiString mode;
  const bool is_opaque = is_linear_ && (source.Get("$mat.gltf.alphaMode", 0, 0, mode) != AI_SUCCESS ||
                                        std::strcmp(mode.C_Str(), "BLEND") != 0);
  if (source.Get(AI_MATKEY_OPACITY, opacity) != AI_SUCCESS) opacity = is_linear_ ? color.a : 1.0F;
  material.rgba[3] = is_opaque ? 1.0 : std::clamp(double{opacity}, 0.0, 1.0);
  const std::string path = texture_path(source);
  if (!path.empty()) {
    const Texture& texture = texture_of(path);
    const bool is_black = material.rgba.head<3>().maxCoeff() < 0.01;  // written by some programs beside a texture
    if (is_black && !texture.file.empty()) material.rgba.head<3>().setOnes();
    if (!texture.file.empty() && !has_coordinates) {
      material.rgba.head<3>() = material.rgba.head<3>().cwiseProduct(texture.mean).eval();
      scene_.rows.push_back({"texture " + texture.file, "its mean color, for a mesh without texture coordinates", ""});
    } else {
      material.texture = texture.file;
      material.texture_length_m = 0.0;
    }
  }
  const std::string name = name_of_material(source);
  material.name = unique_name(name == AI_DEFAULT_MATERIAL_NAME ? "surface" : name);
  scene_.materials.push_back(std::move(material));
  return found->second;
}

}  // namespace patrol::importer
