#include "importer/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>
#include <utility>

#include <Eigen/Geometry>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/gltf_header.h"
#include "importer/mesh_reader.h"
#include "importer/mesh_text.h"

namespace patrol::importer {
namespace {

using Color = std::array<double, 4>;

/// Triangles of a file, by color.
struct PartsByColor {
  std::vector<MeshPart> parts;
  std::map<std::pair<bool, Color>, std::size_t> index_of;

  MeshPart& at(bool has_color, const Color& color) {
    const auto [found, is_new] = index_of.try_emplace({has_color, color}, parts.size());
    if (is_new) {
      parts.emplace_back();
      if (has_color) parts.back().rgba = {color[0], color[1], color[2], color[3]};
      parts.back().has_color = has_color;
    }
    return parts[found->second];
  }
};

void add_triangles(const aiMesh& source, const aiMatrix4x4& T_root_node, Mesh& mesh) {
  const int first = static_cast<int>(mesh.vertices_m.size());
  const aiMatrix3x3 rotation(T_root_node);
  aiMatrix3x3 for_normals = rotation;
  for_normals.Inverse().Transpose();
  for (unsigned i = 0; i < source.mNumVertices; ++i) {
    const aiVector3D p = T_root_node * source.mVertices[i];
    const aiVector3D n = source.HasNormals() ? for_normals * source.mNormals[i] : aiVector3D(0.0F, 0.0F, 1.0F);
    mesh.vertices_m.emplace_back(p.x, p.y, p.z);
    const Eigen::Vector3d normal(n.x, n.y, n.z);
    mesh.normals.push_back(normal.norm() > 0.0 && normal.allFinite() ? normal.normalized() : Eigen::Vector3d::UnitZ());
  }
  const bool is_mirrored = rotation.Determinant() < 0.0F;
  for (unsigned i = 0; i < source.mNumFaces; ++i) {
    const aiFace& face = source.mFaces[i];
    if (face.mNumIndices != 3) continue;
    std::array<int, 3> triangle{};
    for (unsigned k = 0; k < 3; ++k) triangle[k] = first + static_cast<int>(face.mIndices[k]);
    if (is_mirrored) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
}

/// Returns the diffuse color of a material. Assimp gives a file without materials one of its own name.
std::pair<bool, Color> color_of(const aiMaterial& material) {
  aiString name;
  aiColor4D diffuse;
  material.Get(AI_MATKEY_NAME, name);
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != AI_SUCCESS || name == aiString(AI_DEFAULT_MATERIAL_NAME))
    return {false, {}};
  const auto rounded = [](float value) { return std::round(1000.0 * std::clamp(double{value}, 0.0, 1.0)) / 1000.0; };
  return {true, {rounded(diffuse.r), rounded(diffuse.g), rounded(diffuse.b), 1.0}};
}

void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_root_parent, PartsByColor& parts) {
  const aiMatrix4x4 T_root_node = T_root_parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const auto [has_color, color] = color_of(*scene.mMaterials[mesh.mMaterialIndex]);
    add_triangles(mesh, T_root_node, parts.at(has_color, color).mesh);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], T_root_node, parts);
}

int root_of(std::vector<int>& parents, int i) {
  while (parents[static_cast<std::size_t>(i)] != i) {
    int& parent = parents[static_cast<std::size_t>(i)];
    parent = parents[static_cast<std::size_t>(parent)];
    i = parent;
  }
  return i;
}

}  // namespace

std::vector<MeshPart> load_mesh(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) throw InputError(file.string() + ": mesh file not found");
  check_mesh_text(file);
  if (is_gltf(file)) read_gltf_header(file);
  MeshReader reader(file);
  const aiScene& scene = reader.read(aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_SortByPType |
                                     aiProcess_JoinIdenticalVertices);
  PartsByColor by_color;
  add_node(scene, *scene.mRootNode, aiMatrix4x4(), by_color);
  std::erase_if(by_color.parts, [](const MeshPart& part) { return part.mesh.empty(); });
  if (by_color.parts.empty()) throw InputError(file.string() + ": mesh has no triangles");
  for (const MeshPart& part : by_color.parts) check_finite(part.mesh, file);
  return std::move(by_color.parts);
}

Mesh join(const std::vector<Mesh>& meshes) {
  Mesh all;
  for (const Mesh& mesh : meshes) {
    const int first = static_cast<int>(all.vertices_m.size());
    all.vertices_m.insert(all.vertices_m.end(), mesh.vertices_m.begin(), mesh.vertices_m.end());
    for (const std::array<int, 3>& t : mesh.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

Mesh scaled(const Mesh& mesh, const Eigen::Vector3d& factors) {
  Mesh result = mesh;
  for (Eigen::Vector3d& vertex : result.vertices_m) vertex = vertex.cwiseProduct(factors).eval();
  for (Eigen::Vector3d& normal : result.normals) normal = normal.cwiseQuotient(factors).normalized();
  if (factors.prod() < 0.0) {
    for (std::array<int, 3>& triangle : result.triangles) std::swap(triangle[1], triangle[2]);
  }
  return result;
}

Mesh transformed(const Mesh& mesh, const Pose3& T_new_old) {
  Mesh result = mesh;
  for (Eigen::Vector3d& vertex : result.vertices_m) vertex = T_new_old * vertex;
  for (Eigen::Vector3d& normal : result.normals) normal = T_new_old.rotation * normal;
  return result;
}

double max_coordinate_m(const Mesh& mesh) {
  double max = 0.0;
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) max = std::max(max, vertex.cwiseAbs().maxCoeff());
  return max;
}

double diagonal_m(const Mesh& mesh) {
  if (mesh.vertices_m.empty()) return 0.0;
  Eigen::Vector3d lower = mesh.vertices_m.front(), upper = lower;
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) {
    lower = lower.cwiseMin(vertex);
    upper = upper.cwiseMax(vertex);
  }
  return (upper - lower).norm();
}

Mesh welded(const Mesh& mesh) {
  const double cell_m = std::max(1e-6 * diagonal_m(mesh), 1e-12);
  Mesh result;
  std::map<std::array<std::int64_t, 3>, int> index_of;
  std::vector<int> new_index(mesh.vertices_m.size());
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) {
    std::array<std::int64_t, 3> cell{};
    for (int k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] = std::llround((mesh.vertices_m[i] - mesh.vertices_m.front())[k] / cell_m);
    const auto [found, is_new] = index_of.try_emplace(cell, static_cast<int>(result.vertices_m.size()));
    if (is_new) result.vertices_m.push_back(mesh.vertices_m[i]);
    new_index[i] = found->second;
  }
  for (const std::array<int, 3>& t : mesh.triangles) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = new_index[static_cast<std::size_t>(t[k])];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    result.triangles.push_back(triangle);
  }
  return result;
}

bool is_closed(const Mesh& welded_mesh) {
  std::map<std::pair<int, int>, int> count;  // directed edge to number of triangles
  for (const std::array<int, 3>& t : welded_mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
  }
  return !count.empty() && std::all_of(count.begin(), count.end(), [&count](const auto& entry) {
    const auto opposite = count.find({entry.first.second, entry.first.first});
    return entry.second == 1 && opposite != count.end() && opposite->second == 1;
  });
}

std::vector<Mesh> components(const Mesh& welded_mesh) {
  std::vector<int> parents(welded_mesh.vertices_m.size());
  std::iota(parents.begin(), parents.end(), 0);
  for (const std::array<int, 3>& t : welded_mesh.triangles) {
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}})
      parents[static_cast<std::size_t>(root_of(parents, t[k]))] = root_of(parents, t[0]);
  }
  std::vector<Mesh> parts;
  std::map<int, std::size_t> part_of;  // root to part
  std::vector<int> new_index(welded_mesh.vertices_m.size(), -1);
  for (const std::array<int, 3>& t : welded_mesh.triangles) {
    const auto [found, is_new] = part_of.try_emplace(root_of(parents, t[0]), parts.size());
    if (is_new) parts.emplace_back();
    Mesh& part = parts[found->second];
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      int& index = new_index[static_cast<std::size_t>(t[k])];
      if (index < 0) {
        index = static_cast<int>(part.vertices_m.size());
        part.vertices_m.push_back(welded_mesh.vertices_m[static_cast<std::size_t>(t[k])]);
      }
      triangle[k] = index;
    }
    part.triangles.push_back(triangle);
  }
  return parts;
}

SolidProperties integrate(const Mesh& mesh) {
  SolidProperties solid;
  if (mesh.empty()) return solid;
  const Eigen::Vector3d origin = mesh.vertices_m.front();  // near the solid, against cancellation
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const std::array<int, 3>& t : mesh.triangles) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k)
      corners.col(k) = mesh.vertices_m[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])] - origin;
    const double volume = corners.determinant() / 6.0;
    const Eigen::Vector3d sum = corners.rowwise().sum();
    solid.volume_m3 += volume;
    first += volume / 4.0 * sum;
    second += volume / 20.0 * (corners * corners.transpose() + sum * sum.transpose());
  }
  if (std::abs(solid.volume_m3) < 1e-15) return {};
  const Eigen::Vector3d center = first / solid.volume_m3;
  second -= solid.volume_m3 * center * center.transpose();
  solid.center_m = origin + center;
  solid.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return solid;
}

std::string to_obj(const Mesh& mesh, const std::vector<Eigen::Vector2d>& texture_coordinates) {
  std::string text;
  const auto number = [](double value) { return std::abs(value) < 5e-9 ? 0.0 : value; };
  for (const Eigen::Vector3d& v : mesh.vertices_m)
    text += fmt::format("v {:.8g} {:.8g} {:.8g}\n", number(v.x()), number(v.y()), number(v.z()));
  for (const Eigen::Vector2d& uv : texture_coordinates)
    text += fmt::format("vt {:.6g} {:.6g}\n", number(uv.x()), number(uv.y()));
  for (const Eigen::Vector3d& n : mesh.normals)
    text += fmt::format("vn {:.5g} {:.5g} {:.5g}\n", number(n.x()), number(n.y()), number(n.z()));
  const bool has_uv = !texture_coordinates.empty(), has_normals = !mesh.normals.empty();
  const auto corner = [&](int vertex) {
    const int i = vertex + 1;
    if (has_normals) return has_uv ? fmt::format("{0}/{0}/{0}", i) : fmt::format("{0}//{0}", i);
    return has_uv ? fmt::format("{0}/{0}", i) : fmt::format("{}", i);
  };
  for (const std::array<int, 3>& t : mesh.triangles)
    text += fmt::format("f {} {} {}\n", corner(t[0]), corner(t[1]), corner(t[2]));
  return text;
}

}  // namespace patrol::importer
