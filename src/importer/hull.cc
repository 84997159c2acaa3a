#include "importer/hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "core/geometry/linear_algebra.h"

namespace patrol::importer {
namespace {

/// Face of a hull under construction, counterclockwise seen from outside.
struct Face {
  std::array<int, 3> corners;
  Eigen::Vector3d normal;
  double offset = 0.0;

  double distance(const Eigen::Vector3d& point) const { return normal.dot(point) - offset; }
};

Face make_face(const std::vector<Eigen::Vector3d>& points, int a, int b, int c) {
  const Eigen::Vector3d &pa = points[static_cast<std::size_t>(a)], &pb = points[static_cast<std::size_t>(b)],
                        &pc = points[static_cast<std::size_t>(c)];
  Face face{.corners = {a, b, c}, .normal = (pb - pa).cross(pc - pa).stableNormalized()};
  face.offset = face.normal.dot((pa + pb + pc) / 3.0);
  return face;
}

/// Keeps the extreme points of about 1,500 directions. A hull of few vertices needs no more.
std::vector<Eigen::Vector3d> extreme_points(const std::vector<Eigen::Vector3d>& points) {
  constexpr int kNumDirections = 1500;
  if (points.size() <= kNumDirections) return points;
  std::set<std::size_t> kept;
  const auto keep = [&](const Eigen::Vector3d& direction) {
    std::size_t best = 0;
    double max = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double value = direction.dot(points[i]);
      if (value > max) max = value, best = i;
    }
    kept.insert(best);
  };
  for (int i = 0; i < kNumDirections; ++i) {  // Fibonacci lattice on the sphere
    const double z = 1.0 - (2.0 * i + 1.0) / kNumDirections, radius = std::sqrt(1.0 - z * z);
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    keep({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  for (int axis = 0; axis < 3; ++axis) {
    keep(Eigen::Vector3d::Unit(axis));
    keep(-Eigen::Vector3d::Unit(axis));
  }
  std::vector<Eigen::Vector3d> result;
  for (const std::size_t i : kept) result.push_back(points[i]);
  return result;
}

template <typename Value>
int arg_max(const std::vector<Eigen::Vector3d>& points, const Value& value) {
  const auto less = [&value](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return value(a) < value(b); };
  return static_cast<int>(std::max_element(points.begin(), points.end(), less) - points.begin());
}

/// Replaces the faces that the point sees by faces from their horizon to the point. Returns false and changes nothing
/// if rounding leaves a horizon that is not one loop.
bool add_point(const std::vector<Eigen::Vector3d>& points, int index, double tolerance_m, std::vector<Face>& faces) {
  const Eigen::Vector3d& point = points[static_cast<std::size_t>(index)];
  std::map<std::pair<int, int>, std::size_t> face_of;  // directed edge to face
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) face_of[{faces[f].corners[k], faces[f].corners[(k + 1) % 3]}] = f;
  }
  const auto extreme = std::max_element(faces.begin(), faces.end(), [&point](const Face& a, const Face& b) {
    return a.distance(point) < b.distance(point);
  });
  std::vector<std::size_t> open = {static_cast<std::size_t>(extreme - faces.begin())};
  std::set<std::size_t> visible(open.begin(), open.end());
  std::vector<std::pair<int, int>> horizon;
  while (!open.empty()) {
    const std::array<int, 3> corners = faces[open.back()].corners;
    open.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      const std::size_t neighbor = face_of.at({b, a});
      if (visible.contains(neighbor)) continue;
      if (faces[neighbor].distance(point) > tolerance_m) {
        visible.insert(neighbor);
        open.push_back(neighbor);
      }
    }
  }
  for (const std::size_t f : visible) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = faces[f].corners[k], b = faces[f].corners[(k + 1) % 3];
      if (!visible.contains(face_of.at({b, a}))) horizon.emplace_back(a, b);
    }
  }
  std::set<int> starts;
  for (const auto& [a, b] : horizon) starts.insert(a);
  if (starts.size() != horizon.size()) return false;
  for (auto f = visible.rbegin(); f != visible.rend(); ++f)
    faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(*f));
  for (const auto& [a, b] : horizon) faces.push_back(make_face(points, a, b, index));
  return true;
}

Mesh to_mesh(const std::vector<Eigen::Vector3d>& points, const std::vector<Face>& faces) {
  Mesh mesh;
  std::map<int, int> new_index;
  for (const Face& face : faces) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [found, is_new] = new_index.try_emplace(face.corners[k], static_cast<int>(mesh.vertices_m.size()));
      if (is_new) mesh.vertices_m.push_back(points[static_cast<std::size_t>(face.corners[k])]);
      triangle[k] = found->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

Eigen::Vector3d mean_vertex(const Mesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) sum += vertex;
  return sum / static_cast<double>(std::max<std::size_t>(1, mesh.vertices_m.size()));
}

/// Returns whether all vertices of `inner` are inside a convex mesh.
bool encloses(const Mesh& outer, const Mesh& inner) {
  const double tolerance_m = 1e-6 * diagonal_m(outer);
  for (const std::array<int, 3>& t : outer.triangles) {
    const Face face = make_face(outer.vertices_m, t[0], t[1], t[2]);
    for (const Eigen::Vector3d& vertex : inner.vertices_m) {
      if (face.distance(vertex) > tolerance_m) return false;
    }
  }
  return true;
}

/// Merges the smallest part with its nearest neighbor until at most `max_parts` are left. Largest first.
int merge_parts(std::size_t max_parts, std::vector<Mesh>& parts) {
  int num_merged = 0;
  while (parts.size() > max_parts) {
    const Eigen::Vector3d center = mean_vertex(parts.back());
    std::size_t nearest = 0;
    double min_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
      const double distance_m = (mean_vertex(parts[i]) - center).norm() - 0.5 * diagonal_m(parts[i]);
      if (distance_m < min_m) min_m = distance_m, nearest = i;
    }
    parts[nearest] = join({parts[nearest], parts.back()});
    parts.pop_back();
    ++num_merged;
  }
  return num_merged;
}

}  // namespace

Mesh convex_hull(const std::vector<Eigen::Vector3d>& all_points_m, int max_vertices) {
  std::vector<Eigen::Vector3d> points = extreme_points(all_points_m);
  if (points.size() < 3) return {};
  const int a = arg_max(points, [](const Eigen::Vector3d& p) { return p.x(); });
  const Eigen::Vector3d pa = points[static_cast<std::size_t>(a)];
  const int b = arg_max(points, [&pa](const Eigen::Vector3d& p) { return (p - pa).squaredNorm(); });
  const double size_m = (points[static_cast<std::size_t>(b)] - pa).norm();
  if (size_m <= 0.0) return {};
  const Eigen::Vector3d along = (points[static_cast<std::size_t>(b)] - pa) / size_m;
  const auto lateral = [&](const Eigen::Vector3d& p) { return (p - pa).cross(along).squaredNorm(); };
  int c = arg_max(points, lateral);
  if (lateral(points[static_cast<std::size_t>(c)]) < 1e-12 * size_m * size_m) return {};
  const Eigen::Vector3d normal = along.cross(points[static_cast<std::size_t>(c)] - pa).normalized();
  const auto height = [&](const Eigen::Vector3d& p) { return std::abs(normal.dot(p - pa)); };
  int d = arg_max(points, height);
  constexpr double kMinThickness_m = 1e-3;
  if (height(points[static_cast<std::size_t>(d)]) < 1e-2 * kMinThickness_m) {
    std::vector<Eigen::Vector3d> extruded;
    for (const Eigen::Vector3d& p : points) {
      extruded.push_back(p - 0.5 * kMinThickness_m * normal);
      extruded.push_back(p + 0.5 * kMinThickness_m * normal);
    }
    return convex_hull(extruded, max_vertices);
  }
  if (normal.dot(points[static_cast<std::size_t>(d)] - pa) > 0.0) std::swap(c, d);
  // With d below the plane of a, b, c, the faces are counterclockwise from outside.
  std::vector<Face> faces = {make_face(points, a, b, c), make_face(points, a, d, b), make_face(points, b, d, c),
                             make_face(points, c, d, a)};
  const double tolerance_m = 1e-9 * size_m;
  for (int num_vertices = 4; num_vertices < max_vertices; ++num_vertices) {
    int extreme = -1;
    double max_m = std::max(tolerance_m, 1e-7 * size_m);
    for (std::size_t i = 0; i < points.size(); ++i) {
      double outside_m = -std::numeric_limits<double>::infinity();
      for (const Face& face : faces) outside_m = std::max(outside_m, face.distance(points[i]));
      if (outside_m > max_m) max_m = outside_m, extreme = static_cast<int>(i);
    }
    if (extreme < 0 || !add_point(points, extreme, tolerance_m, faces)) break;
  }
  return to_mesh(points, faces);
}

ConvexPieces convex_pieces(const Mesh& mesh, const PieceLimits& limits) {
  constexpr std::size_t kMaxEnclosing = 32;  // hulls that are searched for enclosed parts: the largest
  ConvexPieces result;
  std::vector<Mesh> parts = components(welded(mesh));
  const auto is_small = [&limits](const Mesh& part) { return diagonal_m(part) < limits.min_size_m; };
  if (std::all_of(parts.begin(), parts.end(), is_small)) parts = {join(parts)};
  else result.num_dropped += static_cast<int>(std::erase_if(parts, is_small));
  for (Mesh& part : parts) part = convex_hull(part.vertices_m, limits.max_vertices);
  result.num_dropped += static_cast<int>(std::erase_if(parts, [](const Mesh& part) { return part.empty(); }));
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Mesh& a, const Mesh& b) { return diagonal_m(a) > diagonal_m(b); });
  for (std::size_t i = 0; i < std::min(parts.size(), kMaxEnclosing); ++i) {
    const Mesh outer = parts[i];
    const auto is_inside = [&outer](const Mesh& part) { return encloses(outer, part); };
    const auto end = std::remove_if(parts.begin() + static_cast<std::ptrdiff_t>(i) + 1, parts.end(), is_inside);
    result.num_dropped += static_cast<int>(parts.end() - end);
    parts.erase(end, parts.end());
  }
  result.num_merged = merge_parts(static_cast<std::size_t>(limits.max_pieces), parts);
  for (const Mesh& part : parts) {
    Mesh hull = convex_hull(part.vertices_m, limits.max_vertices);
    if (!hull.empty()) result.pieces.push_back(std::move(hull));
  }
  return result;
}

}  // namespace patrol::importer
