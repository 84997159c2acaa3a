#pragma once

#include <map>
#include <string>
#include <vector>

#include "importer/site/imported_site.h"
#include "importer/site/mesh_scene.h"
#include "importer/site/sdf_world.h"

namespace patrol::importer {

/// Makes shapes of the geometry of SDF.
class SdfShapes {
 public:
  /// Materials, textures and rows go to `site`. The arguments must outlive the object.
  SdfShapes(const SdfWorld& world, ImportedSite& site) : world_(world), site_(site) {}

  /// Returns the shapes of a geometry at the pose; none for <empty>. `material`: name of a material of the site; empty:
  /// those of the mesh, or gray. Meshes are kSeen, with further ones that are kVisualOnly (mesh_site.h).
  std::vector<SiteShape> shapes_of(const sdf::Geometry& geometry, const std::string& name, const Pose3& T_site_shape,
                                   const std::string& material);

  /// Returns the name of the material of a visual, which is added to the site; empty: the visual has none.
  std::string material_of(const sdf::Visual& visual);

  /// Returns the material of shapes without one.
  std::string gray();

  /// Returns `wanted`, with a number if a shape has this name.
  std::string unique_name(const std::string& wanted);

 private:
  void add_row_once(const Assumption& row);
  std::string add_material(const std::string& name, const Eigen::Vector4d& rgba);
  std::vector<SiteShape> mesh_shapes(const sdf::Mesh& mesh, const std::string& name, const Pose3& T_site_shape,
                                     const std::string& material);
  SiteShape height_map(const sdf::Heightmap& map, const SiteShape& common);
  std::vector<SiteShape> polylines(const sdf::ElementPtr& element, const SiteShape& common);
  SiteShape cone_shape(const sdf::ElementPtr& geometry, const SiteShape& common);
  const MeshScene& scene_of(const sdf::Mesh& mesh);

  const SdfWorld& world_;
  ImportedSite& site_;
  std::map<std::string, MeshScene> scenes_;  ///< mesh scenes by path and submesh
  std::map<std::string, int> names_;         ///< uses of names
};

}  // namespace patrol::importer
