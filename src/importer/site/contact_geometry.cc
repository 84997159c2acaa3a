#include "importer/site/contact_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/hull.h"
#include "importer/site/ground_surface.h"
#include "importer/site/obstacle_boxes.h"

namespace patrol::importer {
namespace {

constexpr double kConvex_m = 0.02;    // deviation of a convex component from its hull
constexpr double kHullGap_m2 = 0.01;  // area that a hull may have more than its component
constexpr int kHullVertices = 128;
constexpr std::size_t kHullTriangles = 20000;  // larger components are not tested
constexpr std::size_t kMaxHulls = 4000;
constexpr double kMinHull_m = 0.2;       // diagonal; smaller components become boxes
constexpr double kLevel_m = 0.01;        // deviation of a level ground from its plane
constexpr double kAboveGround_m = 0.03;  // surfaces nearer to the ground belong to it

const Eigen::Vector3d& corner(const Mesh& mesh, const std::array<int, 3>& triangle, std::size_t k) {
  return mesh.vertices_m[static_cast<std::size_t>(triangle[k])];
}

double area_m2(const Mesh& mesh) {
  double area = 0.0;
  for (const std::array<int, 3>& t : mesh.triangles) {
    const Eigen::Vector3d& a = corner(mesh, t, 0);
    area += 0.5 * (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a).norm();
  }
  return area;
}

/// Plane of a face of a hull: normal.dot(p) = offset, positive outside.
struct FacePlane {
  Eigen::Vector3d normal;
  double offset = 0.0;
};

std::vector<FacePlane> planes_of(const Mesh& hull) {
  std::vector<FacePlane> planes;
  for (const std::array<int, 3>& t : hull.triangles) {
    const Eigen::Vector3d& a = corner(hull, t, 0);
    const Eigen::Vector3d normal = (corner(hull, t, 1) - a).cross(corner(hull, t, 2) - a).stableNormalized();
    planes.push_back({normal, normal.dot(a)});
  }
  return planes;
}

/// Returns whether a point is within kConvex_m of the surface of a hull.
bool is_at_surface(const std::vector<FacePlane>& planes, const Eigen::Vector3d& point) {
  double distance = -1e9;
  for (const FacePlane& plane : planes) distance = std::max(distance, plane.normal.dot(point) - plane.offset);
  return std::abs(distance) <= kConvex_m;
}

/// Returns whether points of all triangles, at most 5 cm or a tenth of their edges apart, are at the surface of a hull.
bool is_at_surface(const Mesh& mesh, const std::vector<FacePlane>& planes) {
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) {
    if (!is_at_surface(planes, vertex)) return false;
  }
  for (const std::array<int, 3>& t : mesh.triangles) {
    const Eigen::Vector3d &a = corner(mesh, t, 0), &b = corner(mesh, t, 1), &c = corner(mesh, t, 2);
    const double max_edge_m =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()}));
    const int parts = std::clamp(static_cast<int>(std::ceil(max_edge_m / 0.05)), 1, 10);
    for (int i = 0; i <= parts; ++i) {
      for (int k = 0; i + k <= parts; ++k) {
        const double u = double(i) / parts, v = double(k) / parts;
        if (!is_at_surface(planes, a + u * (b - a) + v * (c - a))) return false;
      }
    }
  }
  return true;
}

/// Returns the hull of a component that is solid and convex, or flat and convex; an empty mesh otherwise.
Mesh hull_if_convex(const Mesh& component) {
  if (component.triangles.size() > kHullTriangles || diagonal_m(component) < kMinHull_m) return {};
  const bool closed = is_closed(component);
  if (closed && integrate(component).volume_m3 <= 0.0) return {};  // a room seen from inside
  Mesh hull = convex_hull(component.vertices_m, kHullVertices);
  if (hull.empty()) return {};
  const double thickness_m = integrate(hull).volume_m3 / std::max(1e-12, 0.5 * area_m2(hull));
  const bool is_flat = thickness_m < kConvex_m;
  if (!closed && !is_flat) return {};
  const double sides = closed ? 1.0 : 0.5;
  if (sides * area_m2(hull) - area_m2(component) > kHullGap_m2) return {};
  if (!is_at_surface(component, planes_of(hull))) return {};
  return hull;
}

/// Components of a mesh: convex ones as hulls with the component, and the others together.
struct Split {
  std::vector<std::pair<Mesh, Mesh>> hulls;  ///< hull and component, largest component first
  Mesh rest;
};

Split split(const Mesh& mesh) {
  Split parts;
  std::vector<Mesh> rest;
  for (Mesh& component : components(welded(mesh))) {
    Mesh hull = hull_if_convex(component);
    if (hull.empty()) rest.push_back(std::move(component));
    else parts.hulls.emplace_back(std::move(hull), std::move(component));
  }
  std::stable_sort(parts.hulls.begin(), parts.hulls.end(),
                   [](const auto& a, const auto& b) { return diagonal_m(a.first) > diagonal_m(b.first); });
  for (std::size_t i = kMaxHulls; i < parts.hulls.size(); ++i) rest.push_back(std::move(parts.hulls[i].second));
  if (parts.hulls.size() > kMaxHulls) parts.hulls.resize(kMaxHulls);
  parts.rest = join(rest);
  return parts;
}

GridGeometry grid_of(const Mesh& mesh, const ContactOptions& options, double& cell_m) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) box.extend(vertex.head<2>().eval());
  for (;; cell_m *= 2.0) {
    const Eigen::Array2d first = (box.min().array() / cell_m).floor() - 1.0;
    const Eigen::Array2d count = (box.max().array() / cell_m).floor() + 2.0 - first;
    if (count.prod() > static_cast<double>(options.max_cells)) continue;
    return {.resolution_m = cell_m,
            .width = static_cast<int>(count.x()),
            .height = static_cast<int>(count.y()),
            .origin_m = first * cell_m};
  }
}

/// Highest height above the ground of the vertices of a mesh, and the lowest.
std::pair<double, double> heights_above(const GroundSurface& ground, const Mesh& mesh) {
  double lowest = 1e9, highest = -1e9;
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) {
    const double height = vertex.z() - ground.at(vertex.head<2>());
    lowest = std::min(lowest, height), highest = std::max(highest, height);
  }
  return {lowest, highest};
}

/// Text of a height without the digits below 0.1 mm.
std::string height_text(double height_m) {
  constexpr double kPerMeter = 1e4;
  return fmt::format("{:.4g}", std::round(kPerMeter * height_m) / kPerMeter + 0.0);  // adding 0 removes the sign of -0
}

SiteShape contact_shape(std::string name, SiteShapeType type) {
  return {.name = std::move(name), .type = type, .use = ShapeUse::kContactOnly, .material = kContactMaterial};
}

/// Adds the ground, unless it consists of given surfaces only.
void add_ground(const GroundSurface& ground, const GridGeometry& grid, ContactGeometry& contact) {
  const auto [lowest, highest] = std::minmax_element(ground.height_m.values().begin(), ground.height_m.values().end());
  contact.ground_area_m2 = ground.area_m2;
  if (ground.is_found && ground.own_area_m2 <= 1e-3 * ground.area_m2) {
    contact.rows.push_back({"ground", "the surfaces with contact of their own", ""});
    return;
  }
  const char* side = ground.is_oriented ? (ground.faces_up ? "" : " whose triangles face down")
                     : ground.faces_up  ? " with 1 m of free height, because triangles face both sides"
                                        : " with less than 1 m of free height: triangles face both sides";
  const std::string found = ground.is_found ? fmt::format("{:.4g} m2 of walkable surface{}", ground.area_m2, side)
                                            : "no walkable surface of 1 m2, the lowest point of the mesh";
  const double middle_m = 0.5 * (double{*lowest} + double{*highest});
  if (double{*highest} - middle_m <= kLevel_m) {
    SiteShape plane = contact_shape("contact_ground", SiteShapeType::kPlane);
    const Eigen::Vector2d half = 0.5 * grid.resolution_m * Eigen::Vector2d(grid.width, grid.height);
    plane.T_site_shape.position << grid.origin_m + half, middle_m;
    plane.size_m << half, 0.0;
    contact.shapes.push_back(std::move(plane));
    contact.rows.push_back(
        {"ground", fmt::format("{}: a level plane at {} m, also outside of the mesh", found, height_text(middle_m)),
         "--start"});
    return;
  }
  SiteShape field = contact_shape("contact_ground", SiteShapeType::kHeightField);
  field.height_field = {.height_m = ground.height_m, .is_ground = ground.is_ground};
  contact.shapes.push_back(std::move(field));
  contact.rows.push_back(
      {"ground",
       fmt::format("{}: a height field of {} x {} cells of {:g} m from {} to {} m; cells "
                   "without ground have the height of a drop or of the nearest ground",
                   found, grid.width, grid.height, grid.resolution_m, height_text(*lowest), height_text(*highest)),
       "--start, --contact-cell"});
}

int add_hulls(const Split& parts, const GroundSurface& ground, double height_m, ContactGeometry& contact) {
  int count = 0;
  for (const auto& [hull, component] : parts.hulls) {
    const auto [lowest, highest] = heights_above(ground, component);
    if (highest <= kAboveGround_m || lowest > height_m) continue;
    SiteShape shape = contact_shape(fmt::format("contact_hull_{}", ++count), SiteShapeType::kMesh);
    shape.mesh = hull;
    contact.shapes.push_back(std::move(shape));
  }
  return count;
}

void add_boxes(const std::vector<Eigen::AlignedBox3d>& boxes, ContactGeometry& contact) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    SiteShape shape = contact_shape(fmt::format("contact_box_{}", i + 1), SiteShapeType::kBox);
    shape.T_site_shape.position = boxes[i].center();
    shape.size_m = 0.5 * boxes[i].sizes();
    contact.shapes.push_back(std::move(shape));
  }
}

}  // namespace

SiteMaterial contact_material() { return {.name = kContactMaterial, .rgba = {0.5, 0.5, 0.5, 1.0}}; }

ContactGeometry contact_geometry(const Mesh& mesh, const Mesh& given, const ContactOptions& options) {
  if (max_coordinate_m(mesh) > kMaxCoordinate_m) throw InputError(far_text(max_coordinate_m(mesh)));
  const Split parts = split(mesh);
  double cell_m = options.cell_m;
  for (int attempt = 0;; ++attempt, cell_m *= 2.0) {
    const GridGeometry grid = grid_of(mesh, options, cell_m);
    const GroundSurface ground = find_ground(mesh, given, grid, options.start);
    const std::vector<Eigen::AlignedBox3d> boxes = obstacle_boxes(parts.rest, ground, kAboveGround_m, options.height_m);
    if (boxes.size() > options.max_boxes && attempt < 2) continue;
    ContactGeometry contact;
    add_ground(ground, grid, contact);
    const int num_hulls = add_hulls(parts, ground, options.height_m, contact);
    add_boxes(boxes, contact);
    contact.rows.push_back(
        {"contact",
         fmt::format("{} convex components as their hulls, other surfaces up to {:g} m above the ground as {} "
                     "boxes of cells of {:g} m",
                     num_hulls, options.height_m, boxes.size(), cell_m),
         "--contact-cell"});
    return contact;
  }
}

}  // namespace patrol::importer
