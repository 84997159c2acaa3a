#include "importer/site/sdf_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "importer/gltf_header.h"
#include "importer/site/mesh_site.h"
#include "importer/site/polygon_mesh.h"
#include "importer/site/texture_image.h"
#include "io/files/atomic_file.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

/// Diffuse color of a material script of Gazebo Classic, in American spelling.
struct GazeboColor {
  std::string_view name;
  double r, g, b;
};

constexpr std::array kGazeboColors = std::to_array<GazeboColor>({
    {"Gazebo/Gray", 0.7, 0.7, 0.7},
    {"Gazebo/DarkGray", 0.175, 0.175, 0.175},
    {"Gazebo/White", 1.0, 1.0, 1.0},
    {"Gazebo/FlatBlack", 0.1, 0.1, 0.1},
    {"Gazebo/Black", 0.0, 0.0, 0.0},
    {"Gazebo/Red", 1.0, 0.0, 0.0},
    {"Gazebo/RedBright", 0.87, 0.26, 0.07},
    {"Gazebo/Green", 0.0, 1.0, 0.0},
    {"Gazebo/Blue", 0.0, 0.0, 1.0},
    {"Gazebo/SkyBlue", 0.13, 0.44, 0.7},
    {"Gazebo/Yellow", 1.0, 1.0, 0.0},
    {"Gazebo/DarkYellow", 0.7, 0.7, 0.0},
    {"Gazebo/Purple", 1.0, 0.0, 1.0},
    {"Gazebo/Turquoise", 0.0, 1.0, 1.0},
    {"Gazebo/Orange", 1.0, 0.5, 0.05},
    {"Gazebo/Indigo", 0.33, 0.0, 0.5},
});

Eigen::Vector4d to_rgba(const ignition::math::Color& c) {
  return Eigen::Vector4d(double{c.R()}, double{c.G()}, double{c.B()}, double{c.A()}).cwiseMax(0.0).cwiseMin(1.0);
}

bool has_set(const sdf::ElementPtr& element, const std::string& child) {
  return element && element->HasElement(child) && element->GetElement(child)->GetExplicitlySetInFile();
}

Mesh placed(const Mesh& mesh, const Eigen::Vector3d& scale) {
  Mesh result = scaled(mesh, scale);
  for (Eigen::Vector3d& normal : result.normals) {
    if (!normal.allFinite()) normal = Eigen::Vector3d::UnitZ();
  }
  return result;
}

void require_positive(const SdfWorld& world, const sdf::ElementPtr& element, std::initializer_list<double> sizes) {
  for (const double size : sizes) {
    if (!(size > 0.0) || !std::isfinite(size)) world.fail(element, fmt::format("size = {:g}: must be positive", size));
  }
}

}  // namespace

std::string SdfShapes::unique_name(const std::string& wanted) {
  const std::string name = io::on_one_line(wanted);
  const int uses = ++names_[name];
  return uses == 1 ? name : unique_name(fmt::format("{}_{}", name, uses));
}

std::string SdfShapes::add_material(const std::string& name, const Eigen::Vector4d& rgba) {
  for (int i = 1;; ++i) {
    const std::string candidate = i == 1 ? name : fmt::format("{}_{}", name, i);
    const auto found = std::find_if(site_.materials.begin(), site_.materials.end(),
                                    [&](const SiteMaterial& material) { return material.name == candidate; });
    if (found == site_.materials.end()) {
      site_.materials.push_back({.name = candidate, .rgba = rgba});
      return candidate;
    }
    if (found->rgba == rgba && found->texture.empty()) return candidate;
  }
}

std::string SdfShapes::gray() { return add_material("gray", {0.7, 0.7, 0.7, 1.0}); }

std::string SdfShapes::material_of(const sdf::Visual& visual) {
  const sdf::Material* material = visual.Material();
  const double opacity = std::clamp(1.0 - double{visual.Transparency()}, 0.0, 1.0);
  if (material == nullptr) return opacity < 1.0 ? add_material("transparent", {0.7, 0.7, 0.7, opacity}) : std::string();
  Eigen::Vector4d rgba = {0.7, 0.7, 0.7, 1.0};
  const std::string script = io::on_one_line(material->ScriptName());
  if (has_set(material->Element(), "diffuse")) rgba = to_rgba(material->Diffuse());
  else if (has_set(material->Element(), "ambient")) rgba = to_rgba(material->Ambient());
  else if (!script.empty()) {
    std::string spelled = script;
    if (const std::size_t at = spelled.find("rey"); at != std::string::npos) spelled[at + 1] = 'a';
    const auto found = std::find_if(kGazeboColors.begin(), kGazeboColors.end(),
                                    [&](const GazeboColor& color) { return color.name == spelled; });
    if (found != kGazeboColors.end()) rgba.head<3>() = Eigen::Vector3d(found->r, found->g, found->b);
    else add_row_once({"script " + script, "unknown material: gray", "<diffuse>"});
  } else if (opacity >= 1.0) {
    return {};
  }
  rgba[3] *= opacity;
  return add_material(script.empty() ? "color" : script, rgba);
}

void SdfShapes::add_row_once(const Assumption& row) {
  const bool is_new = std::none_of(site_.assumptions.begin(), site_.assumptions.end(),
                                   [&](const Assumption& other) { return other.subject == row.subject; });
  if (is_new) site_.assumptions.push_back(row);
}

const MeshScene& SdfShapes::scene_of(const sdf::Mesh& mesh) {
  const sdf::ElementPtr element = mesh.Element();
  const std::filesystem::path file = world_.resolve(mesh.Uri(), element);
  const std::string key = fmt::format("{}|{}|{}", file.string(), mesh.Submesh(), mesh.CenterSubmesh());
  if (const auto found = scenes_.find(key); found != scenes_.end()) return found->second;
  MeshScene scene;
  try {
    scene = read_mesh_scene(file, fmt::format("mesh_{}/", scenes_.size() + 1),
                            {.submesh = mesh.Submesh(), .is_centered = mesh.CenterSubmesh()});
  } catch (const InputError& error) {
    world_.fail(element, error.what());
  }
  to_site_axes(scene, {.unit_m = 1.0, .up = is_gltf(file) ? 'y' : 'z'});
  const std::vector<std::filesystem::path> ends = Packages::ends_of(mesh.Uri());
  if (!is_of_network(mesh.Uri()) && !ends.empty() && !file.string().ends_with(ends.front().string()))
    site_.assumptions.push_back(
        {"mesh " + file.filename().string(),
         fmt::format("not found where the file names it: {} is used", io::on_one_line(world_.relative(file))),
         "--package NAME=FOLDER"});
  if (!is_gltf(file) && scene.up == 'y')
    site_.assumptions.push_back(
        {"mesh " + file.filename().string(), "its up axis is not applied, as in RViz", "the file"});
  for (const Assumption& row : scene.rows)
    site_.assumptions.push_back({file.filename().string() + ": " + row.subject, row.text, row.override_with});
  site_.materials.insert(site_.materials.end(), scene.materials.begin(), scene.materials.end());
  std::move(scene.textures.begin(), scene.textures.end(), std::back_inserter(site_.files));
  scene.textures.clear();
  return scenes_.emplace(key, std::move(scene)).first->second;
}

std::vector<SiteShape> SdfShapes::mesh_shapes(const sdf::Mesh& mesh, const std::string& name, const Pose3& T_site_shape,
                                              const std::string& material) {
  const ignition::math::Vector3d& s = mesh.Scale();
  if (s.X() == 0.0 || s.Y() == 0.0 || s.Z() == 0.0) world_.fail(mesh.Element(), "scale: must not be 0");
  std::vector<SiteShape> shapes = seen_shapes(scene_of(mesh), name);
  for (SiteShape& shape : shapes) {
    shape.name = unique_name(shape.name);
    shape.T_site_shape = T_site_shape;
    shape.mesh = placed(shape.mesh, {s.X(), s.Y(), s.Z()});
    if (!material.empty()) {
      shape.material = material;
      shape.texture_coordinates.clear();
    }
  }
  return shapes;
}

SiteShape SdfShapes::height_map(const sdf::Heightmap& map, const SiteShape& common) {
  const std::filesystem::path file = world_.resolve(map.Uri(), map.Element());
  const auto image = decode_image(io::load_text(file), file.extension().string(), 1 << 14);
  if (!image) world_.fail(map.Element(), map.Uri() + ": must be a picture, elevation models are not supported");
  if (image->width < 2 || image->height < 2)
    world_.fail(map.Element(), map.Uri() + ": must have at least 2 x 2 pixels");
  const double step_m = map.Size().X() / (image->width - 1);
  require_positive(world_, map.Element(), {map.Size().X(), map.Size().Y(), map.Size().Z()});
  if (std::abs(map.Size().Y() / (image->height - 1) - step_m) > 1e-6 * step_m)
    world_.fail(map.Element(), "cells that are not square are not supported");
  const Eigen::Vector2d first = -0.5 * Eigen::Vector2d(map.Size().X(), map.Size().Y());
  const Eigen::Vector2d corner = first - Eigen::Vector2d::Constant(0.5 * step_m);
  SiteShape shape = common;
  shape.type = SiteShapeType::kHeightField;
  shape.height_field.height_m = Grid<float>(
      GridGeometry{.resolution_m = step_m, .width = image->width, .height = image->height, .origin_m = corner});
  // Gazebo scales the brightest pixel to the height (HeightmapShape: size.z / MaxElevation).
  std::uint8_t brightest = 1;
  for (std::size_t pixel = 0; pixel < image->rgb.size(); pixel += 3) brightest = std::max(brightest, image->rgb[pixel]);
  const double step_height_m = map.Size().Z() / brightest;
  for (int row = 0; row < image->height; ++row) {
    for (int col = 0; col < image->width; ++col) {
      const auto pixel = static_cast<std::size_t>(3 * ((image->height - 1 - row) * image->width + col));
      shape.height_field.height_m.at({col, row}) = static_cast<float>(image->rgb[pixel] * step_height_m);
    }
  }
  const ignition::math::Vector3d& p = map.Position();
  shape.T_site_shape = common.T_site_shape * Pose3{{p.X(), p.Y(), p.Z()}, Eigen::Quaterniond::Identity()};
  add_row_once(
      {"heightmap " + file.filename().string(),
       "heights of 8 bits, the brightest pixel at the height of <size>; textures and blends are ignored; one color",
       "a mesh"});
  return shape;
}

std::vector<SiteShape> SdfShapes::polylines(const sdf::ElementPtr& element, const SiteShape& common) {
  const sdf::ElementPtr polyline = element->GetElement("polyline");
  if (polyline->GetNextElement("polyline"))
    world_.fail(polyline, "several polylines of one geometry are not supported");
  std::vector<Eigen::Vector2d> corners;
  for (sdf::ElementPtr point = polyline->GetElement("point"); point; point = point->GetNextElement("point")) {
    const auto p = point->Get<ignition::math::Vector2d>();
    corners.emplace_back(p.X(), p.Y());
  }
  SiteShape shape = common;
  shape.type = SiteShapeType::kMesh;
  shape.mesh = extruded_polygon(corners, polyline->Get<double>("height"));
  if (shape.mesh.empty()) world_.fail(polyline, "must be a polygon without self-intersection");
  return {shape};
}

SiteShape SdfShapes::cone_shape(const sdf::ElementPtr& geometry, const SiteShape& common) {
  // libsdformat 12 copies the element without its line and with the values as text.
  const sdf::ElementPtr element = geometry->GetElement("cone");
  const auto size_of = [&](const char* name) {
    const auto [size, is_number] = element->Get<double>(name, 0.0);
    if (!(size > 0.0) || !std::isfinite(size))
      world_.fail(geometry, fmt::format("<cone>: <{}> must be positive", name));
    return size;
  };
  SiteShape shape = common;
  shape.type = SiteShapeType::kMesh;
  shape.mesh = cone(size_of("radius"), size_of("length"));
  return shape;
}

std::vector<SiteShape> SdfShapes::shapes_of(const sdf::Geometry& geometry, const std::string& name,
                                            const Pose3& T_site_shape, const std::string& material) {
  if (geometry.Type() == sdf::GeometryType::MESH)
    return mesh_shapes(*geometry.MeshShape(), name, T_site_shape, material);
  SiteShape shape = {.name = unique_name(name),
                     .use = ShapeUse::kSeen,
                     .T_site_shape = T_site_shape,
                     .material = material.empty() ? gray() : material};
  const sdf::ElementPtr element = geometry.Element();
  switch (geometry.Type()) {
    case sdf::GeometryType::BOX: {
      const ignition::math::Vector3d size = geometry.BoxShape()->Size();
      require_positive(world_, geometry.BoxShape()->Element(), {size.X(), size.Y(), size.Z()});
      shape.size_m = 0.5 * Eigen::Vector3d(size.X(), size.Y(), size.Z());
      return {shape};
    }
    case sdf::GeometryType::CYLINDER: {
      const sdf::Cylinder& cylinder = *geometry.CylinderShape();
      require_positive(world_, cylinder.Element(), {cylinder.Radius(), cylinder.Length()});
      shape.type = SiteShapeType::kCylinder;
      shape.size_m = {cylinder.Radius(), 0.5 * cylinder.Length(), 0.0};
      return {shape};
    }
    case sdf::GeometryType::CAPSULE: {
      const sdf::Capsule& capsule = *geometry.CapsuleShape();
      require_positive(world_, capsule.Element(), {capsule.Radius(), capsule.Length()});
      shape.type = SiteShapeType::kCapsule;
      shape.size_m = {capsule.Radius(), 0.5 * capsule.Length(), 0.0};
      return {shape};
    }
    case sdf::GeometryType::SPHERE:
      require_positive(world_, geometry.SphereShape()->Element(), {geometry.SphereShape()->Radius()});
      shape.type = SiteShapeType::kSphere;
      shape.size_m = {geometry.SphereShape()->Radius(), 0.0, 0.0};
      return {shape};
    case sdf::GeometryType::ELLIPSOID: {
      const ignition::math::Vector3d radii = geometry.EllipsoidShape()->Radii();
      require_positive(world_, geometry.EllipsoidShape()->Element(), {radii.X(), radii.Y(), radii.Z()});
      shape.type = SiteShapeType::kEllipsoid;
      shape.size_m = {radii.X(), radii.Y(), radii.Z()};
      return {shape};
    }
    case sdf::GeometryType::PLANE: {
      const ignition::math::Vector3d n = geometry.PlaneShape()->Normal();
      const ignition::math::Vector2d size = geometry.PlaneShape()->Size();
      shape.type = SiteShapeType::kPlane;
      shape.size_m = {0.5 * size.X(), 0.5 * size.Y(), 0.0};
      shape.T_site_shape.rotation = shape.T_site_shape.rotation *
                                    rotation_between(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(n.X(), n.Y(), n.Z()));
      return {shape};
    }
    case sdf::GeometryType::HEIGHTMAP:
      return {height_map(*geometry.HeightmapShape(), shape)};
    case sdf::GeometryType::MESH:
    case sdf::GeometryType::EMPTY:
      break;
  }
  if (element && element->HasElement("polyline")) return polylines(element, shape);
  if (element && element->HasElement("cone")) return {cone_shape(element, shape)};
  return {};
}

}  // namespace patrol::importer
