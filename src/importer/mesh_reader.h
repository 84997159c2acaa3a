#pragma once

#include <filesystem>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include "importer/mesh.h"

namespace patrol::importer {

/// Reads a mesh file by libassimp, with the up axis of the file, normals smoothed up to 40 degrees, and without lines
/// and points.
class MeshReader {
 public:
  explicit MeshReader(std::filesystem::path file);

  /// Reads the file. `steps`: flags of aiPostProcessSteps. The scene belongs to the reader. Throws InputError with the
  /// file and the message of libassimp.
  const aiScene& read(unsigned steps);
  /// Applies further steps to the scene that was read. Throws like `read`.
  const aiScene& process(unsigned steps);

 private:
  const aiScene& checked(const aiScene* scene) const;

  std::filesystem::path file_;
  Assimp::Importer importer_;
};

/// Throws InputError with the file if a vertex is not finite.
void check_finite(const Mesh& mesh, const std::filesystem::path& file);

}  // namespace patrol::importer
