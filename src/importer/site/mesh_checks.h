#pragma once

#include <filesystem>

#include <assimp/scene.h>

namespace patrol::importer {

/// Refuses content of mesh files with which libassimp 5.2 does not terminate: the header of a PLY file without its end,
/// lists of indices in a DAE file that are not integers, and what check_mesh_text refuses. Throws InputError with the
/// file.
void check_mesh_file(const std::filesystem::path& file);

/// Refuses meshes with which the later steps of libassimp fail: faces with indices of vertices that do not exist, and
/// types of faces that contradict the faces. Throws InputError with the file.
void check_faces(const std::filesystem::path& file, const aiScene& scene);

}  // namespace patrol::importer
