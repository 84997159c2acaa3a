#pragma once

#include <map>
#include <set>
#include <string>

#include <assimp/scene.h>

#include "importer/site/mesh_scene.h"

namespace patrol::importer {

/// Reads the materials and textures of a scene of libassimp into a `MeshScene`.
class MeshMaterials {
 public:
  /// `file` and `prefix` as for `read_mesh_scene`. The arguments must outlive the object.
  MeshMaterials(const aiScene& source, const std::filesystem::path& file, std::string prefix, MeshScene& scene);

  /// Returns the index in the scene of a material of libassimp. `has_coordinates`: the mesh has texture coordinates;
  /// without them a texture becomes its mean color.
  std::size_t of(unsigned index, bool has_coordinates);

  /// Returns the index of a material of one color, which is created at its first use.
  std::size_t plain(const std::string& name, const Eigen::Vector4d& rgba);

  /// Returns whether the material has no texture and a gray color, so that colors of vertices determine the color.
  bool is_gray(unsigned index) const;

 private:
  /// Returns whether the material determines a color or has a texture.
  bool has_color(unsigned index) const;

  /// Texture of a material: a file below textures/, or only a color.
  struct Texture {
    std::string file;  ///< empty: cannot be read
    Eigen::Vector3d mean = Eigen::Vector3d::Constant(0.7);
  };

  std::string unique_name(const std::string& wanted);
  const Texture& texture_of(const std::string& path);
  Texture load(const std::string& path);

  const aiScene& source_;
  const std::filesystem::path& file_;
  std::string prefix_;
  MeshScene& scene_;
  bool is_linear_;  ///< colors of the file are linear light, as those of glTF
  std::map<std::pair<unsigned, bool>, std::size_t> index_of_;
  std::map<std::string, std::size_t> plain_;
  std::map<std::string, Texture> textures_;
  std::set<std::string> names_;
};

}  // namespace patrol::importer
