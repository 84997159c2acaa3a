#include "importer/site/site_mjcf.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "io/files/markup_text.h"

namespace patrol::importer {
namespace {

/// Physics of the street: the contacts of feet, tracks and wheels are tuned with these (worlds/street/street.xml).
constexpr const char* kHead = R"(<mujoco model="{}">
  <compiler angle="degree" autolimits="true"/>
  <option timestep="0.002" cone="elliptic" impratio="10" integrator="Euler" solver="Newton"/>
  <statistic extent="30" center="{:.6g} {:.6g} {:.6g}"/>
  <visual>
    <global offwidth="1920" offheight="1080" fovy="50"/>
    <quality shadowsize="2048" offsamples="0"/>
    <map znear="0.003" zfar="20" fogstart="4" fogend="20" shadowclip="0.5" haze="0"/>
    <headlight ambient="0.40 0.41 0.43" diffuse="0.25 0.25 0.25" specular="0 0 0"/>
  </visual>
  <default>
    <default class="solid"><geom group="0" contype="1" conaffinity="2"/></default>
    <default class="seen"><geom group="0" contype="0" conaffinity="0"/></default>
    <default class="visual_only"><geom group="1" contype="0" conaffinity="0"/></default>
    <default class="lidar_only"><geom group="2" contype="0" conaffinity="0"/></default>
    <default class="contact_only"><geom group="3" contype="1" conaffinity="2"/></default>
  </default>
  <asset>
    <texture name="sky" type="skybox" builtin="gradient" rgb1="0.93 0.95 0.97" rgb2="0.62 0.74 0.86" width="256" height="1536"/>
)";

const char* class_of(ShapeUse use) {
  switch (use) {
    case ShapeUse::kSolid:
      return "solid";
    case ShapeUse::kSeen:
      return "seen";
    case ShapeUse::kVisualOnly:
      return "visual_only";
    case ShapeUse::kLidarOnly:
      return "lidar_only";
    case ShapeUse::kContactOnly:
      return "contact_only";
  }
  return "";
}

/// Lowest and highest height of a height field, at least a millimeter apart.
std::array<float, 2> height_range_m(const Grid<float>& heights_m) {
  constexpr float kThin_m = 1e-3F;
  const auto [lowest, highest] = std::minmax_element(heights_m.values().begin(), heights_m.values().end());
  return {*lowest, std::max(*highest, *lowest + kThin_m)};
}

std::string vector_text(const Eigen::Vector3d& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z()); }

std::string quaternion_text(const Eigen::Quaterniond& q) {
  return fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}", q.w(), q.x(), q.y(), q.z());
}

std::string material_asset(const SiteMaterial& material) {
  const std::string name = io::escaped_markup(material.name);
  const std::string texture = io::escaped_markup(material.texture);
  const Eigen::Vector4d& c = material.rgba;
  std::string text;
  if (!texture.empty())
    text += fmt::format("    <texture name=\"{}\" type=\"2d\" file=\"textures/{}\"/>\n", name, texture);
  text +=
      fmt::format("    <material name=\"{}\" rgba=\"{:.4g} {:.4g} {:.4g} {:.4g}\" specular=\"0.05\" shininess=\"0.2\"",
                  name, c.x(), c.y(), c.z(), c.w());
  if (!texture.empty() && material.texture_length_m <= 0.0) text += fmt::format(" texture=\"{}\"", name);
  if (!texture.empty() && material.texture_length_m > 0.0) {
    const double repeat = 1.0 / material.texture_length_m;
    text += fmt::format(" texture=\"{0}\" texuniform=\"true\" texrepeat=\"{1:.6g} {1:.6g}\"", name, repeat);
  }
  return text + "/>\n";
}

std::string shape_asset(const SiteShape& shape) {
  const std::string name = io::escaped_markup(shape.name), file = io::escaped_markup(shape_file(shape));
  if (shape.type == SiteShapeType::kMesh) {
    // Surfaces without volume have the inertia of a shell; static geoms need none.
    return fmt::format("    <mesh name=\"{}\" file=\"{}\" inertia=\"shell\"/>\n", name, file);
  }
  if (shape.type != SiteShapeType::kHeightField) return "";
  constexpr double kBase_m = 0.5;  // thickness below the lowest point
  const Grid<float>& heights = shape.height_field.height_m;
  const GridGeometry& grid = heights.geometry();
  const auto [lowest, highest] = height_range_m(heights);
  return fmt::format(
      "    <hfield name=\"{}\" file=\"{}\" content_type=\"image/vnd.mujoco.hfield\" size=\"{:.9g} {:.9g} {:.9g} "
      "{}\"/>\n",
      name, file, 0.5 * grid.resolution_m * (grid.width - 1), 0.5 * grid.resolution_m * (grid.height - 1),
      double{highest} - double{lowest}, kBase_m);
}

/// Pose of the geom in site: that of the shape, or the middle of a height field at its lowest height.
Pose3 geom_pose(const SiteShape& shape) {
  if (shape.type != SiteShapeType::kHeightField) return shape.T_site_shape;
  const GridGeometry& grid = shape.height_field.height_m.geometry();
  const Eigen::Vector2d middle = grid.origin_m + 0.5 * grid.resolution_m * Eigen::Vector2d(grid.width, grid.height);
  const double lowest_m = double{height_range_m(shape.height_field.height_m)[0]};
  return shape.T_site_shape * Pose3{{middle.x(), middle.y(), lowest_m}, Eigen::Quaterniond::Identity()};
}

std::string geom(const SiteShape& shape) {
  const std::string name = io::escaped_markup(shape.name);
  const Pose3 pose = geom_pose(shape);
  std::string form;
  switch (shape.type) {
    case SiteShapeType::kBox:
      form = fmt::format("type=\"box\" size=\"{}\"", vector_text(shape.size_m));
      break;
    case SiteShapeType::kCylinder:
      form = fmt::format("type=\"cylinder\" size=\"{:.9g} {:.9g}\"", shape.size_m.x(), shape.size_m.y());
      break;
    case SiteShapeType::kCapsule:
      form = fmt::format("type=\"capsule\" size=\"{:.9g} {:.9g}\"", shape.size_m.x(), shape.size_m.y());
      break;
    case SiteShapeType::kEllipsoid:
      form = fmt::format("type=\"ellipsoid\" size=\"{}\"", vector_text(shape.size_m));
      break;
    case SiteShapeType::kSphere:
      form = fmt::format("type=\"sphere\" size=\"{:.9g}\"", shape.size_m.x());
      break;
    case SiteShapeType::kPlane:
      form = fmt::format("type=\"plane\" size=\"{:.9g} {:.9g} 1\"", shape.size_m.x(), shape.size_m.y());
      break;
    case SiteShapeType::kMesh:
      form = fmt::format("type=\"mesh\" mesh=\"{}\"", name);
      break;
    case SiteShapeType::kHeightField:
      form = fmt::format("type=\"hfield\" hfield=\"{}\"", name);
      break;
  }
  return fmt::format("    <geom name=\"{}\" class=\"{}\" {} pos=\"{}\" quat=\"{}\" material=\"{}\"/>\n", name,
                     class_of(shape.use), form, vector_text(pose.position), quaternion_text(pose.rotation),
                     io::escaped_markup(shape.material));
}

template <typename Value>
void append(std::string& bytes, Value value) {
  std::array<char, sizeof value> raw{};
  std::memcpy(raw.data(), &value, sizeof value);
  bytes.append(raw.data(), raw.size());
}

std::string height_field_bytes(const Grid<float>& heights_m) {
  std::string bytes;
  append(bytes, static_cast<std::int32_t>(heights_m.geometry().height));
  append(bytes, static_cast<std::int32_t>(heights_m.geometry().width));
  for (const float height_m : heights_m.values()) append(bytes, height_m);
  return bytes;
}

/// Corners of the box around the shapes that have an end, in site.
Eigen::AlignedBox3d box_of(const ImportedSite& site) {
  Eigen::AlignedBox3d box;
  for (const SiteShape& shape : site.shapes) {
    if (shape.type == SiteShapeType::kPlane) continue;
    box.extend(geom_pose(shape).position);
    for (const Eigen::Vector3d& vertex : shape.mesh.vertices_m) box.extend(shape.T_site_shape * vertex);
  }
  return box.isEmpty() ? Eigen::AlignedBox3d(Eigen::Vector3d::Zero()) : box;
}

}  // namespace

std::string shape_file(const SiteShape& shape) {
  std::string name;  // one name of a file for each name of a shape
  for (const char c : shape.name) {
    if (c == '/' || c == '%') name += fmt::format("%{:02X}", static_cast<int>(c));
    else name += c;
  }
  return "meshes/" + name + (shape.type == SiteShapeType::kMesh ? ".obj" : ".hfield");
}

std::string shape_content(const SiteShape& shape) {
  if (shape.type == SiteShapeType::kHeightField) return height_field_bytes(shape.height_field.height_m);
  // MuJoCo wants at least four vertices: the last one of a single triangle is repeated.
  constexpr std::size_t kFewest = 4;
  if (shape.mesh.vertices_m.size() >= kFewest) return to_obj(shape.mesh, shape.texture_coordinates);
  Mesh mesh = shape.mesh;
  std::vector<Eigen::Vector2d> texture_coordinates = shape.texture_coordinates;
  mesh.vertices_m.resize(kFewest, mesh.vertices_m.back());
  if (!mesh.normals.empty()) mesh.normals.resize(kFewest, mesh.normals.back());
  if (!texture_coordinates.empty()) texture_coordinates.resize(kFewest, texture_coordinates.back());
  return to_obj(mesh, texture_coordinates);
}

std::string to_mjcf(const ImportedSite& site) {
  const Eigen::AlignedBox3d box = box_of(site);
  const Eigen::Vector3d center = box.center();
  std::string text =
      fmt::format(fmt::runtime(kHead), io::escaped_markup(site.name), center.x(), center.y(), center.z());
  for (const SiteMaterial& material : site.materials) text += material_asset(material);
  for (const SiteShape& shape : site.shapes) text += shape_asset(shape);
  text += fmt::format(
      "  </asset>\n  <worldbody>\n    <light name=\"sun\" directional=\"true\" pos=\"{:.6g} {:.6g} {:.6g}\" "
      "dir=\"-0.35 0.45 -0.82\" diffuse=\"0.5 0.48 0.45\" specular=\"0.1 0.1 0.1\" castshadow=\"true\"/>\n",
      center.x(), center.y(), box.max().z() + 20.0);
  for (const SiteShape& shape : site.shapes) text += geom(shape);
  return text + "  </worldbody>\n</mujoco>\n";
}

}  // namespace patrol::importer
