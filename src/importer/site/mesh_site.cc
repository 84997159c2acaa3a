#include "importer/site/mesh_site.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace patrol::importer {
namespace {

Eigen::AlignedBox3d box_of_scene(const MeshScene& scene) {
  Eigen::AlignedBox3d box;
  for (const ScenePart& part : scene.parts) {
    for (const Eigen::Vector3d& vertex : part.mesh.vertices_m) box.extend(vertex);
  }
  return box;
}

/// Area of the triangles that face along an axis within 37 degrees, in the lowest third along it.
double low_area(const MeshScene& scene, const Eigen::AlignedBox3d& box, int axis) {
  constexpr double kFacing = 0.8;
  const double limit = box.min()[axis] + box.sizes()[axis] / 3.0;
  double area = 0.0;
  for (const ScenePart& part : scene.parts) {
    for (const std::array<int, 3>& t : part.mesh.triangles) {
      const auto at = [&](std::size_t k) -> const Eigen::Vector3d& {
        return part.mesh.vertices_m[static_cast<std::size_t>(t[k])];
      };
      if ((at(0)[axis] + at(1)[axis] + at(2)[axis]) / 3.0 > limit) continue;
      const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0));
      if (std::abs(normal[axis]) >= kFacing * normal.norm()) area += 0.5 * normal.norm();
    }
  }
  return area;
}

char up_by_rule(const MeshScene& scene, const Eigen::AlignedBox3d& box, SceneFrame& frame) {
  const double y = low_area(scene, box, 1), z = low_area(scene, box, 2);
  const char up = y > z ? 'y' : 'z';
  frame.rows.push_back(
      {"up axis",
       fmt::format(
           "{}: its level surfaces in the lowest third have the larger area ({:.3g} against {:.3g} square units)", up,
           std::max(y, z), std::min(y, z)),
       "--up"});
  return up;
}

double unit_by_rule(const Eigen::AlignedBox3d& box, char up, SceneFrame& frame) {
  constexpr double kMaxLength_m = 1000.0, kMaxHeight_m = 100.0, kUsualHeight_m = 5.0;
  const double height = box.sizes()[up - 'x'], length = box.sizes().maxCoeff();
  double unit_m = 1.0;
  if (length > kMaxLength_m || height > kMaxHeight_m) {
    const auto deviation = [&](double unit) {
      return std::abs(std::log(std::max(1e-9, unit * height) / kUsualHeight_m));
    };
    unit_m = deviation(0.01) < deviation(0.001) ? 0.01 : 0.001;
  }
  const Eigen::Vector3d size_m = unit_m * box.sizes();
  frame.rows.push_back({"scale",
                        fmt::format("{:g} m per unit, by the extent: {:.4g} x {:.4g} x {:.4g} m", unit_m, size_m.x(),
                                    size_m.y(), size_m.z()),
                        "--scale"});
  return unit_m;
}

/// Splits the triangle of a mesh of three vertices, because MuJoCo requires four.
void split_single_triangle(SiteShape& shape) {
  Mesh& mesh = shape.mesh;
  if (mesh.vertices_m.size() != 3 || mesh.triangles.empty()) return;
  const std::array<int, 3> t = mesh.triangles.front();
  const auto middle = [&](auto& values) {
    if (values.empty()) return;
    const auto a = values[static_cast<std::size_t>(t[0])], b = values[static_cast<std::size_t>(t[1])];
    values.push_back(0.5 * (a + b));
  };
  middle(mesh.vertices_m);
  middle(mesh.normals);
  middle(shape.texture_coordinates);
  mesh.triangles = {{t[0], 3, t[2]}, {3, t[1], t[2]}};
}

void add_far_row(const MeshScene& scene, std::vector<Assumption>& rows) {
  constexpr double kFar_m = 2000.0;
  double max_m = 0.0;
  for (const ScenePart& part : scene.parts) max_m = std::max(max_m, max_coordinate_m(part.mesh));
  if (max_m > kFar_m)
    rows.push_back(
        {"coordinates",
         fmt::format("up to {:.0f} m from the origin: single precision is {:.1g} m there", max_m, max_m * 6e-8),
         "the file"});
}

}  // namespace

SceneFrame frame_of(const MeshScene& scene, double scale, const std::string& up) {
  SceneFrame frame;
  const Eigen::AlignedBox3d box = box_of_scene(scene);
  if (!up.empty()) frame.up = up.front();
  else if (scene.up != 0) frame.up = scene.up;
  else frame.up = up_by_rule(scene, box, frame);
  if (scale > 0.0) frame.unit_m = scale / scene.applied_unit_m;
  else if (scene.unit_m > 0.0) frame.unit_m = scene.unit_m;
  else frame.unit_m = unit_by_rule(box, frame.up, frame);
  if (up.empty() && scene.up != 0)
    frame.rows.push_back({"up axis", fmt::format("{}, by the format", scene.up), "--up"});
  if (scale <= 0.0 && scene.unit_m > 0.0)
    frame.rows.push_back(
        {"scale", fmt::format("{:g} m per unit, by the format", scene.unit_m * scene.applied_unit_m), "--scale"});
  return frame;
}

void to_site_axes(MeshScene& scene, const SceneFrame& frame) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (frame.up == 'y') R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  if (frame.up == 'x') R << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  for (ScenePart& part : scene.parts) {
    for (Eigen::Vector3d& vertex : part.mesh.vertices_m) vertex = frame.unit_m * (R * vertex);
    for (Eigen::Vector3d& normal : part.mesh.normals) normal = R * normal;
  }
}

ContactOptions contact_options(const SiteImportOptions& options) {
  const std::optional<Pose2>& start = options.mission.start;
  return {.cell_m = options.contact_cell_m, .start = start ? std::optional(start->position()) : std::nullopt};
}

std::vector<SiteShape> seen_shapes(const MeshScene& scene, const std::string& name) {
  constexpr std::size_t kMaxTested = 200'000;  // triangles of a part; larger ones are terrain, seen from above
  std::vector<SiteShape> shapes;
  for (const ScenePart& part : scene.parts) {
    SiteShape shape = {.name = fmt::format("{}_{}", name, shapes.size() + 1),
                       .type = SiteShapeType::kMesh,
                       .use = ShapeUse::kSeen,
                       .material = scene.materials[part.material].name,
                       .mesh = part.mesh,
                       .texture_coordinates = part.texture_coordinates};
    split_single_triangle(shape);
    shapes.push_back(shape);
    if (part.mesh.triangles.size() > kMaxTested || is_closed(welded(part.mesh))) continue;
    shape.name = fmt::format("{}_{}", name, shapes.size() + 1);
    shape.use = ShapeUse::kVisualOnly;
    for (std::array<int, 3>& triangle : shape.mesh.triangles) std::swap(triangle[1], triangle[2]);
    for (Eigen::Vector3d& normal : shape.mesh.normals) normal = -normal;
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

ImportedSite read_mesh_site(const SiteImportOptions& options) {
  MeshScene scene = read_mesh_scene(options.file);
  ImportedSite site{.name = options.name, .source = options.file.string()};
  const SceneFrame frame = frame_of(scene, options.scale, options.up);
  to_site_axes(scene, frame);
  site.assumptions = frame.rows;
  site.assumptions.insert(site.assumptions.end(), scene.rows.begin(), scene.rows.end());
  add_far_row(scene, site.assumptions);
  ContactGeometry contact;
  try {
    contact = contact_geometry(all_triangles(scene), {}, contact_options(options));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", options.file.string(), error.what()));
  }
  site.shapes = seen_shapes(scene, "mesh");
  site.materials = std::move(scene.materials);
  site.materials.push_back(contact_material());
  site.files = std::move(scene.textures);
  std::move(contact.shapes.begin(), contact.shapes.end(), std::back_inserter(site.shapes));
  use_height_fields_as_ground(site);
  site.assumptions.insert(site.assumptions.end(), contact.rows.begin(), contact.rows.end());
  return site;
}

}  // namespace patrol::importer
