#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::importer {

/// Triangle mesh.
struct Mesh {
  std::vector<Eigen::Vector3d> vertices_m;
  std::vector<Eigen::Vector3d> normals;       ///< unit normals, [vertex]; empty if the mesh has none
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices, counterclockwise seen from outside

  bool empty() const { return triangles.empty(); }
};

/// Part of a mesh file with one color.
struct MeshPart {
  Mesh mesh;
  Eigen::Vector4d rgba = {0.7, 0.7, 0.7, 1.0};
  bool has_color = false;  ///< false: the file has no material, and `rgba` is a default
};

/// Reads an STL, OBJ, DAE, glTF or GLB file by libassimp: triangles in meters, with the transforms of the file's nodes.
/// The unit of a DAE file is applied. The up axis of DAE and glTF files is not, as in RViz: coordinates are those of
/// the link. One part for each color. Throws InputError with the file if it cannot be read or has no triangles, and for
/// what check_mesh_text refuses.
std::vector<MeshPart> load_mesh(const std::filesystem::path& file);

/// Returns all parts as one mesh, without normals.
Mesh join(const std::vector<Mesh>& meshes);

/// Returns the mesh scaled along its axes. A mirrored mesh (odd number of negative factors) keeps its triangles
/// counterclockwise.
Mesh scaled(const Mesh& mesh, const Eigen::Vector3d& factors);

Mesh transformed(const Mesh& mesh, const Pose3& T_new_old);

/// Returns the largest absolute coordinate of the vertices, m.
double max_coordinate_m(const Mesh& mesh);

/// Returns the length of the diagonal of the bounding box, m.
double diagonal_m(const Mesh& mesh);

/// Returns the mesh with vertices at equal positions (within 1e-6 of the diagonal) merged, without normals and without
/// triangles of no area.
Mesh welded(const Mesh& mesh);

/// Returns whether every edge of a welded mesh belongs to one triangle in each direction.
bool is_closed(const Mesh& welded_mesh);

/// Returns the connected components of a welded mesh.
std::vector<Mesh> components(const Mesh& welded_mesh);

/// Volume integrals of a solid of density 1.
struct SolidProperties {
  double volume_m3 = 0.0;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< inertia about the center, m^5
};

/// Integrates over the inside of a closed mesh by signed tetrahedra.
SolidProperties integrate(const Mesh& mesh);

/// Returns the text of a Wavefront OBJ file with only `v`, `vt`, `vn` and `f`. `texture_coordinates`: [vertex], or
/// empty.
std::string to_obj(const Mesh& mesh, const std::vector<Eigen::Vector2d>& texture_coordinates = {});

}  // namespace patrol::importer
