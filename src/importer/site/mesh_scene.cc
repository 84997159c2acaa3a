#include "importer/site/mesh_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "core/letter_case.h"
#include "core/text.h"
#include "importer/gltf_header.h"
#include "importer/mesh_reader.h"
#include "importer/site/mesh_checks.h"
#include "importer/site/mesh_materials.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

constexpr std::uintmax_t kMaxFile_bytes = std::uintmax_t{3} << 30;

/// Transform of a node in double precision.
Eigen::Affine3d to_affine(const aiMatrix4x4& m) {
  Eigen::Affine3d T;
  T.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0.0, 0.0, 0.0, 1.0;
  return T;
}

std::size_t count_triangles(const aiScene& scene, const aiNode& node) {
  std::size_t count = 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const unsigned corners = mesh.mFaces[k].mNumIndices;
      count += corners < 3 ? 0 : corners - 2;
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) count += count_triangles(scene, *node.mChildren[i]);
  return count;
}

/// Collects the triangles of the nodes of a scene, by material.
class PartCollector {
 public:
  PartCollector(const aiScene& source, std::string submesh, MeshMaterials& materials, MeshScene& scene)
      : source_(source), submesh_(std::move(submesh)), materials_(materials), scene_(scene) {}

  void add_node(const aiNode& node, const Eigen::Affine3d& T_root_parent) {
    const Eigen::Affine3d T_root_node = T_root_parent * to_affine(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *source_.mMeshes[node.mMeshes[i]];
      const bool is_selected = submesh_.empty() || submesh_ == node.mName.C_Str() || submesh_ == mesh.mName.C_Str();
      if (is_selected) add_mesh(mesh, T_root_node);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], T_root_node);
  }

  std::size_t num_degenerate() const { return num_degenerate_; }
  bool has_vertex_colors() const { return has_vertex_colors_; }

 private:
  ScenePart& part_of(std::size_t material, bool has_coordinates) {
    const auto [found, is_new] = index_of_.try_emplace({material, has_coordinates}, scene_.parts.size());
    if (is_new) scene_.parts.push_back({.mesh = {}, .material = material});
    return scene_.parts[found->second];
  }

  /// Material of a triangle by its vertex colors, in steps of a quarter of each channel.
  std::size_t colored(const aiMesh& mesh, const aiFace& face) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (unsigned k = 0; k < 3; ++k) {
      const aiColor4D& c = mesh.mColors[0][face.mIndices[k]];
      mean += Eigen::Vector3d(c.r, c.g, c.b) / 3.0;
    }
    const Eigen::Vector3d level = (mean.array().max(0.0).min(1.0) * 3.0).round();
    const Eigen::Vector3d color = level / 3.0;
    return materials_.plain(fmt::format("color {:.0f}{:.0f}{:.0f}", level.x(), level.y(), level.z()),
                            {color.x(), color.y(), color.z(), 1.0});
  }

  void add_mesh(const aiMesh& mesh, const Eigen::Affine3d& T) {
    const bool has_coordinates = mesh.HasTextureCoords(0) && mesh.mNumUVComponents[0] >= 2;
    const bool by_vertex = mesh.HasVertexColors(0) && materials_.is_gray(mesh.mMaterialIndex);
    has_vertex_colors_ |= mesh.HasVertexColors(0);
    const Eigen::Matrix3d for_normals = T.linear().inverse().transpose();
    const bool is_mirrored = T.linear().determinant() < 0.0;
    const std::size_t material = by_vertex ? 0 : materials_.of(mesh.mMaterialIndex, has_coordinates);
    const bool keeps_coordinates = has_coordinates && !by_vertex && !scene_.materials[material].texture.empty();
    std::map<std::size_t, std::vector<int>> new_index;  // of vertices, by material
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;
      const std::size_t of_face = by_vertex ? colored(mesh, face) : material;
      ScenePart& part = part_of(of_face, keeps_coordinates);
      std::vector<int>& index = new_index[of_face];
      if (index.empty()) index.assign(mesh.mNumVertices, -1);
      std::array<int, 3> triangle{};
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned vertex = face.mIndices[k];
        if (index[vertex] < 0) index[vertex] = add_vertex(mesh, vertex, T, for_normals, keeps_coordinates, part);
        triangle[k] = index[vertex];
      }
      if (is_mirrored) std::swap(triangle[1], triangle[2]);
      if (has_area(part.mesh, triangle)) part.mesh.triangles.push_back(triangle);
      else ++num_degenerate_;
    }
  }

  static int add_vertex(const aiMesh& mesh, unsigned vertex, const Eigen::Affine3d& T,
                        const Eigen::Matrix3d& for_normals, bool keeps_coordinates, ScenePart& part) {
    const aiVector3D& p = mesh.mVertices[vertex];
    part.mesh.vertices_m.push_back(T * Eigen::Vector3d(p.x, p.y, p.z));
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    if (mesh.HasNormals()) {
      const aiVector3D& n = mesh.mNormals[vertex];
      normal = for_normals * Eigen::Vector3d(n.x, n.y, n.z);
    }
    const bool is_valid = normal.allFinite() && normal.norm() > 0.0;
    part.mesh.normals.push_back(is_valid ? normal.normalized().eval() : Eigen::Vector3d::UnitZ());
    if (keeps_coordinates) {
      const aiVector3D& uv = mesh.mTextureCoords[0][vertex];
      part.texture_coordinates.emplace_back(uv.x, uv.y);
    }
    return static_cast<int>(part.mesh.vertices_m.size()) - 1;
  }

  /// Vertices that are not finite have an area here: they are refused by name later.
  static bool has_area(const Mesh& mesh, const std::array<int, 3>& triangle) {
    const auto corner = [&](int k) -> const Eigen::Vector3d& {
      return mesh.vertices_m[static_cast<std::size_t>(triangle[static_cast<std::size_t>(k)])];
    };
    const Eigen::Vector3d a = corner(1) - corner(0), b = corner(2) - corner(0);
    return !(a.cross(b).norm() <= 1e-12 * std::max(a.squaredNorm(), b.squaredNorm()));
  }

  const aiScene& source_;
  std::string submesh_;
  MeshMaterials& materials_;
  MeshScene& scene_;
  std::map<std::pair<std::size_t, bool>, std::size_t> index_of_;
  std::size_t num_degenerate_ = 0;
  bool has_vertex_colors_ = false;
};

/// Moves the center of the bounding box to the origin.
void center(MeshScene& scene) {
  Eigen::AlignedBox3d box;
  for (const ScenePart& part : scene.parts) {
    for (const Eigen::Vector3d& vertex : part.mesh.vertices_m) box.extend(vertex);
  }
  const Eigen::Vector3d middle = box.center();
  for (ScenePart& part : scene.parts) {
    for (Eigen::Vector3d& vertex : part.mesh.vertices_m) vertex -= middle;
  }
}

/// Reads <unit>, which libassimp applies, and <up_axis> of a Collada file.
void read_collada_asset(const std::filesystem::path& file, MeshScene& scene) {
  tinyxml2::XMLDocument document;
  scene.unit_m = 1.0;
  scene.up = 'y';
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) return;  // libassimp reports it
  const tinyxml2::XMLElement* root = document.RootElement();
  const tinyxml2::XMLElement* asset = root == nullptr ? nullptr : root->FirstChildElement("asset");
  if (asset == nullptr) return;
  if (const tinyxml2::XMLElement* unit = asset->FirstChildElement("unit"))
    scene.applied_unit_m = unit->DoubleAttribute("meter", 1.0);
  const tinyxml2::XMLElement* up = asset->FirstChildElement("up_axis");
  if (up == nullptr || up->GetText() == nullptr) return;
  const std::string text = up->GetText();
  if (text.find("X_UP") != std::string::npos) scene.up = 'x';
  if (text.find("Z_UP") != std::string::npos) scene.up = 'z';
}

/// Adds a row for each material library of an OBJ file that is missing.
void check_material_libraries(const std::filesystem::path& file, MeshScene& scene) {
  constexpr std::size_t kHead_bytes = 1 << 16;
  std::istringstream head(io::load_text(file).substr(0, kHead_bytes));
  for (std::string line; std::getline(head, line);) {
    if (!line.starts_with("mtllib ")) continue;
    const std::string name = line.substr(7, line.find_last_not_of(" \r") - 6);
    std::error_code error;
    if (!std::filesystem::is_regular_file(file.parent_path() / name, error))
      scene.rows.push_back({"mtllib " + io::on_one_line(name), "file not found: the surfaces are gray", "the file"});
  }
}

void add_rows(const aiScene& source, const PartCollector& collector, MeshScene& scene) {
  const auto ignored = [&](unsigned count, const char* subject, const char* text) {
    if (count > 0) scene.rows.push_back({subject, fmt::format("{} in the file: {}", count, text), ""});
  };
  ignored(source.mNumLights, "lights", "ignored, the site has one sun");
  ignored(source.mNumCameras, "cameras", "ignored");
  ignored(source.mNumAnimations, "animations", "ignored, the site is at rest");
  unsigned skins = 0, morphs = 0;
  for (unsigned i = 0; i < source.mNumMeshes; ++i) {
    skins += source.mMeshes[i]->HasBones() ? 1 : 0;
    morphs += source.mMeshes[i]->mNumAnimMeshes > 0 ? 1 : 0;
  }
  ignored(skins, "skins", "ignored, meshes are in their rest pose");
  ignored(morphs, "morph targets", "ignored, meshes have their base shape");
  if (collector.has_vertex_colors())
    scene.rows.push_back(
        {"vertex colors", "of gray surfaces: four levels of each channel, by triangle; others ignored", ""});
  if (collector.num_degenerate() > 0)
    scene.rows.push_back(
        {"triangles", fmt::format("{} without area are left out", collector.num_degenerate()), "the file"});
}

const aiScene& read_scene(const std::filesystem::path& file, MeshReader& reader) {
  const aiScene& raw = reader.read(0);
  check_faces(file, raw);
  const std::size_t count = count_triangles(raw, *raw.mRootNode);
  if (count > kMaxTriangles)
    throw InputError(fmt::format("{}: {} triangles: must be at most {}", file.string(), count, kMaxTriangles));
  unsigned steps = aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_SortByPType;
  // It would join vertices of different colors.
  const bool has_colors = std::any_of(raw.mMeshes, raw.mMeshes + raw.mNumMeshes,
                                      [](const aiMesh* mesh) { return mesh->HasVertexColors(0); });
  if (!has_colors) steps |= aiProcess_JoinIdenticalVertices;
  return reader.process(steps);
}

}  // namespace

std::size_t MeshScene::num_triangles() const {
  std::size_t count = 0;
  for (const ScenePart& part : parts) count += part.mesh.triangles.size();
  return count;
}

MeshScene read_mesh_scene(const std::filesystem::path& file, const std::string& prefix,
                          const SceneSelection& selection) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) throw InputError(file.string() + ": mesh file not found");
  if (std::filesystem::file_size(file, error) > kMaxFile_bytes) throw InputError(file.string() + ": larger than 3 GiB");
  const std::string extension = patrol::to_lower(file.extension().string());
  MeshScene scene;
  if (is_gltf(file)) {
    const GltfHeader header = read_gltf_header(file);
    if (!header.used.empty())
      scene.rows.push_back({"extensionsUsed", patrol::join(header.used, ", ") + ": ignored", ""});
    scene.unit_m = 1.0;
    scene.up = 'y';
  }
  if (extension == ".dae") read_collada_asset(file, scene);
  check_mesh_file(file);
  if (extension == ".obj") check_material_libraries(file, scene);
  MeshReader reader(file);
  const aiScene& source = read_scene(file, reader);
  MeshMaterials materials(source, file, prefix, scene);
  PartCollector collector(source, selection.submesh, materials, scene);
  collector.add_node(*source.mRootNode, Eigen::Affine3d::Identity());
  std::erase_if(scene.parts, [](const ScenePart& part) { return part.mesh.empty(); });
  if (scene.parts.empty() && !selection.submesh.empty())
    throw InputError(fmt::format("{}: submesh \"{}\" not found", file.string(), io::on_one_line(selection.submesh)));
  if (scene.parts.empty()) throw InputError(file.string() + ": mesh has no triangles");
  for (const ScenePart& part : scene.parts) check_finite(part.mesh, file);
  if (selection.is_centered) center(scene);
  add_rows(source, collector, scene);
  return scene;
}

Mesh all_triangles(const MeshScene& scene) {
  Mesh all;
  for (const ScenePart& part : scene.parts) {
    const int first = static_cast<int>(all.vertices_m.size());
    all.vertices_m.insert(all.vertices_m.end(), part.mesh.vertices_m.begin(), part.mesh.vertices_m.end());
    for (const std::array<int, 3>& t : part.mesh.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

}  // namespace patrol::importer
