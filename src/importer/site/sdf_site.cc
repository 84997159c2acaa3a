#include "importer/site/sdf_site.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/site/contact_geometry.h"
#include "importer/site/mesh_site.h"
#include "importer/site/sdf_checks.h"
#include "importer/site/sdf_shapes.h"
#include "importer/site/sdf_state.h"
#include "importer/site/sdf_world.h"

namespace patrol::importer {
namespace {

template <typename Element>
Pose3 resolved(const SdfWorld& world, const Element& element) {
  ignition::math::Pose3d pose;
  const sdf::Errors errors = element.SemanticPose().Resolve(pose);
  if (!errors.empty()) world.fail(element.Element(), errors.front().Message());
  const Pose3 T = to_pose(pose);
  if (!T.position.allFinite() || !T.rotation.coeffs().allFinite()) world.fail(element.Element(), "pose is not finite");
  return T;
}

/// Triangles of a height field in its frame, of the cells whose centers are within a horizontal distance.
Mesh triangles_near(const Grid<float>& height_m, const Eigen::Vector2d& center, double distance_m) {
  const GridGeometry& grid = height_m.geometry();
  Mesh mesh;
  Grid<int> vertex_of(grid, -1);
  const auto vertex = [&](Cell cell) {
    int& index = vertex_of.at(cell);
    if (index >= 0) return index;
    index = static_cast<int>(mesh.vertices_m.size());
    const Eigen::Vector2d p_m = grid.center_of(cell);
    mesh.vertices_m.emplace_back(p_m.x(), p_m.y(), double{height_m.at(cell)});
    return index;
  };
  for (int row = 0; row + 1 < grid.height; ++row) {
    for (int col = 0; col + 1 < grid.width; ++col) {
      if ((grid.center_of({col, row}) - center).norm() > distance_m) continue;
      const int a = vertex({col, row}), b = vertex({col + 1, row}), c = vertex({col + 1, row + 1}),
                d = vertex({col, row + 1});
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

/// Triangles of a box, or of a plane or a height field, which are cut to the surroundings of `box`; empty for other
/// shapes.
Mesh tessellated(const SiteShape& shape, const Eigen::AlignedBox3d& box) {
  Mesh mesh;
  if (shape.type == SiteShapeType::kBox) {
    for (int i = 0; i < 8; ++i)
      mesh.vertices_m.push_back(
          shape.size_m.cwiseProduct(Eigen::Vector3d((i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1)));
    mesh.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 7, 3}, {2, 6, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  } else if (shape.type == SiteShapeType::kPlane) {
    const double reach_m = (box.center() - shape.T_site_shape.position).norm() + box.diagonal().norm() + 1.0;
    mesh.vertices_m = {
        {-reach_m, -reach_m, 0.0}, {reach_m, -reach_m, 0.0}, {reach_m, reach_m, 0.0}, {-reach_m, reach_m, 0.0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  } else if (shape.type == SiteShapeType::kHeightField) {
    const Grid<float>& height_m = shape.height_field.height_m;
    const Eigen::Vector3d center = shape.T_site_shape.inverse() * Eigen::Vector3d(box.center());
    mesh = triangles_near(height_m, center.head<2>(),
                          0.5 * box.diagonal().norm() + 2.0 * height_m.geometry().resolution_m + 1.0);
  }
  return transformed(mesh, shape.T_site_shape);
}

/// Collects the shapes of the models of a world.
class SdfSiteBuilder {
 public:
  SdfSiteBuilder(const SdfWorld& world, ImportedSite& site) : world_(world), site_(site), shapes_(world, site) {}

  void add_world() {
    const std::map<std::string, SdfModelState> states = model_states(world_.world());
    for (std::uint64_t i = 0; i < world_.world().ModelCount(); ++i) {
      const sdf::Model& model = *world_.world().ModelByIndex(i);
      add_model(model, Pose3{}, model.Name(), states);
    }
    if (states.empty()) return;
    site_.assumptions.push_back({"<state>", fmt::format("replaces the poses of {} models", num_moved_), "the file"});
    if (num_scaled_ > 0)
      site_.assumptions.push_back(
          {"<scale>", fmt::format("the state scales the shapes of {} models, as in Gazebo", num_scaled_), "the file"});
  }

  void add_mesh_contacts(const SiteImportOptions& options) {
    if (contact_meshes_.empty()) return;
    Eigen::AlignedBox3d box;
    const Mesh meshes = join(contact_meshes_);
    for (const Eigen::Vector3d& vertex : meshes.vertices_m) box.extend(vertex);
    if (const std::optional<Pose2>& start = options.mission.start)
      box.extend(Eigen::Vector3d(start->x, start->y, box.center().z()));
    std::vector<Mesh> given;
    for (const SiteShape& shape : site_.shapes) {
      if (shape.use == ShapeUse::kContactOnly) given.push_back(tessellated(shape, box));
    }
    ContactGeometry contact;
    try {
      contact = contact_geometry(meshes, join(given), contact_options(options));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", options.file.string(), error.what()));
    }
    for (SiteShape& shape : contact.shapes) shape.name = shapes_.unique_name(shape.name);
    std::move(contact.shapes.begin(), contact.shapes.end(), std::back_inserter(site_.shapes));
    site_.assumptions.insert(site_.assumptions.end(), contact.rows.begin(), contact.rows.end());
  }

 private:
  void add_model(const sdf::Model& model, const Pose3& T_site_parent, const std::string& name,
                 const std::map<std::string, SdfModelState>& states) {
    const auto state = states.find(model.Name());
    const bool has_state = state != states.end();
    const Pose3 T_site_model = has_state ? state->second.T_world_model : T_site_parent * resolved(world_, model);
    scale_ = has_state ? state->second.scale : Eigen::Vector3d::Ones().eval();
    num_moved_ += has_state ? 1 : 0;
    num_scaled_ += scale_ != Eigen::Vector3d::Ones() ? 1 : 0;
    for (std::uint64_t i = 0; i < model.LinkCount(); ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      Pose3 T_site_link = T_site_model * resolved(world_, link);
      if (has_state) {
        const auto link_state = state->second.links.find(link.Name());
        if (link_state != state->second.links.end()) T_site_link = link_state->second;
      }
      add_link(link, T_site_link, name + "." + link.Name());
    }
    const std::map<std::string, SdfModelState> none;
    for (std::uint64_t i = 0; i < model.ModelCount(); ++i) {
      const sdf::Model& nested = *model.ModelByIndex(i);
      add_model(nested, T_site_model, name + "." + nested.Name(), has_state ? state->second.models : none);
    }
  }

  void add_link(const sdf::Link& link, const Pose3& T_site_link, const std::string& name) {
    for (std::uint64_t i = 0; i < link.VisualCount(); ++i) {
      const sdf::Visual& visual = *link.VisualByIndex(i);
      if (visual.Geom() == nullptr) continue;
      const std::string material = shapes_.material_of(visual);
      add(scaled_shapes(*visual.Geom(), name + "." + visual.Name(), T_site_link * resolved(world_, visual), material));
    }
    for (std::uint64_t i = 0; i < link.CollisionCount(); ++i) {
      const sdf::Collision& collision = *link.CollisionByIndex(i);
      if (collision.Geom() == nullptr) continue;
      add_collision(collision, T_site_link * resolved(world_, collision), name + "." + collision.Name(),
                    link.VisualCount() == 0);
    }
  }

  void add_collision(const sdf::Collision& collision, const Pose3& T_site_shape, const std::string& name,
                     bool is_seen_by_lidar) {
    for (SiteShape& shape : scaled_shapes(*collision.Geom(), name, T_site_shape, kContactMaterial)) {
      if (shape.use == ShapeUse::kVisualOnly) continue;
      if (is_seen_by_lidar) {
        SiteShape seen = shape;
        seen.name = shapes_.unique_name(shape.name + ".lidar");
        seen.use = ShapeUse::kLidarOnly;
        site_.shapes.push_back(std::move(seen));
      }
      shape.use = ShapeUse::kContactOnly;
      if (shape.type == SiteShapeType::kMesh) contact_meshes_.push_back(transformed(shape.mesh, shape.T_site_shape));
      else site_.shapes.push_back(std::move(shape));
    }
  }

  std::vector<SiteShape> scaled_shapes(const sdf::Geometry& geometry, const std::string& name,
                                       const Pose3& T_site_shape, const std::string& material) {
    std::vector<SiteShape> shapes = shapes_.shapes_of(geometry, name, T_site_shape, material);
    if (scale_ == Eigen::Vector3d::Ones()) return shapes;
    // The scale of a state replaces that of a mesh (physics::MeshShape::SetScale).
    Eigen::Vector3d factors = scale_;
    if (const sdf::Mesh* mesh = geometry.MeshShape())
      factors = factors.cwiseQuotient(Eigen::Vector3d(mesh->Scale().X(), mesh->Scale().Y(), mesh->Scale().Z()));
    for (SiteShape& shape : shapes) apply_scale(factors, shape);
    return shapes;
  }

  void add(std::vector<SiteShape> shapes) { std::move(shapes.begin(), shapes.end(), std::back_inserter(site_.shapes)); }

  const SdfWorld& world_;
  ImportedSite& site_;
  SdfShapes shapes_;
  std::vector<Mesh> contact_meshes_;                 ///< in site
  Eigen::Vector3d scale_ = Eigen::Vector3d::Ones();  ///< scale of the shapes of the model that is being added
  int num_moved_ = 0;                                ///< models with a state
  int num_scaled_ = 0;                               ///< models with another scale than 1
};

}  // namespace

ImportedSite read_sdf_site(const SiteImportOptions& options) {
  const SdfWorld world(options);
  ImportedSite site{.name = options.name, .source = options.file.string()};
  site.assumptions = world.rows();
  const std::vector<Assumption> ignored = check_elements(world);
  site.assumptions.insert(site.assumptions.end(), ignored.begin(), ignored.end());
  site.materials.push_back(contact_material());
  SdfSiteBuilder builder(world, site);
  builder.add_world();
  builder.add_mesh_contacts(options);
  use_height_fields_as_ground(site);
  if (site.shapes.empty()) throw InputError(options.file.string() + ": the world has no geometry");
  return site;
}

}  // namespace patrol::importer
