#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "importer/assumptions.h"
#include "importer/mesh.h"
#include "importer/site/imported_site.h"

namespace patrol::importer {

/// Triangles of a mesh file with one material, in the file's units and axes.
struct ScenePart {
  Mesh mesh;
  std::vector<Eigen::Vector2d> texture_coordinates = {};  ///< [vertex], v upward; empty: none
  std::size_t material = 0;                               ///< index into `materials`
};

/// Content of a mesh file: parts by material, textures as PNG.
struct MeshScene {
  std::vector<SiteMaterial> materials = {};
  std::vector<ScenePart> parts = {};
  std::vector<SiteFile> textures = {};  ///< texture files below textures/
  double unit_m = 0.0;                  ///< meters per unit of the vertices by the format; 0: the format has none
  double applied_unit_m = 1.0;          ///< meters per unit of the file that the vertices have already
  char up = 0;                          ///< axis that points up by the format, 'x', 'y' or 'z'; 0: the format has none
  std::vector<Assumption> rows = {};    ///< what was left out or replaced
  std::size_t num_triangles() const;
};

/// Largest number of triangles of a site.
constexpr std::size_t kMaxTriangles = 2'000'000;

/// Selection of the nodes of a mesh file.
struct SceneSelection {
  std::string submesh = {};  ///< name of a node or a mesh; empty: all
  bool is_centered = false;  ///< the center of the bounding box is moved to the origin
};

/// Reads a glTF, GLB, OBJ, DAE, PLY or STL file by libassimp: triangles with the transforms of their nodes, base
/// colors, textures (also embedded ones) and texture coordinates. Names of materials and textures begin with `prefix`
/// and are unique. A texture that cannot be read becomes a color with a row. Throws InputError with the file if it
/// cannot be read, has no triangles or no such submesh, more than `kMaxTriangles`, vertices that are not finite, or
/// extensions that are required and not supported.
MeshScene read_mesh_scene(const std::filesystem::path& file, const std::string& prefix = {},
                          const SceneSelection& selection = {});

/// Returns the triangles of all parts as one mesh.
Mesh all_triangles(const MeshScene& scene);

}  // namespace patrol::importer
