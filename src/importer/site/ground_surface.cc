#include "importer/site/ground_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/grid/height_grid.h"
#include "importer/grid/triangle_cells.h"

namespace patrol::importer {
namespace {

constexpr double kMinFree_m = 0.2;        // free height above a walkable surface
constexpr double kStandingFree_m = 1.0;   // free height above a ground whose triangles do not tell its side
constexpr double kMaxWrongRatio = 0.05;   // of the edges of triangles that face both ways
constexpr double kSame_m = 1e-3;          // samples closer than this are one
constexpr double kMinGround_m2 = 1.0;     // smaller surfaces are no ground by rule
constexpr double kMinGroundRatio = 0.25;  // of the largest surface
constexpr double kMaxSlab_m = 0.5;        // thickness of a slab whose underside faces up
constexpr double kMaxTop_m2 = 20.0;       // tops of furniture, vehicles and containers are smaller
constexpr double kMinTop_m = 0.3;         // height of such a top above the floor

/// Surface at the center of a cell.
struct SurfaceSample {
  std::uint32_t cell = 0;
  float z_m = 0.0F;
  bool is_gentle = false;  ///< slope up to 45 degrees
  bool faces_up = false;
  bool is_given = false;
  int surface = -1;  ///< connected surface; -1: not walkable
};

/// Adds the heights of a triangle at the centers of the cells inside of it.
void sample_triangle(const std::array<Eigen::Vector3d, 3>& corners, const GridGeometry& grid, bool is_given,
                     std::vector<SurfaceSample>& samples) {
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const bool is_gentle = std::abs(normal.z()) >= std::sqrt(0.5) * normal.norm() * (1.0 - 1e-9);
  visit_cell_centers(corners, grid, [&](Cell at, double z_m) {
    const std::size_t cell =
        static_cast<std::size_t>(at.row) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(at.col);
    samples.push_back({.cell = static_cast<std::uint32_t>(cell),
                       .z_m = static_cast<float>(z_m),
                       .is_gentle = is_gentle,
                       .faces_up = normal.z() > 0.0,
                       .is_given = is_given});
  });
}

void sample_mesh(const Mesh& mesh, const GridGeometry& grid, bool is_given, std::vector<SurfaceSample>& samples) {
  for (const std::array<int, 3>& t : mesh.triangles) {
    sample_triangle({mesh.vertices_m[static_cast<std::size_t>(t[0])], mesh.vertices_m[static_cast<std::size_t>(t[1])],
                     mesh.vertices_m[static_cast<std::size_t>(t[2])]},
                    grid, is_given, samples);
  }
}

/// Samples of all cells, from the lowest up in each.
class SurfaceSamples {
 public:
  SurfaceSamples(const Mesh& mesh, const Mesh& given, const GridGeometry& grid) : grid_(grid) {
    sample_mesh(mesh, grid, false, samples_);
    sample_mesh(given, grid, true, samples_);
    std::stable_sort(samples_.begin(), samples_.end(), [](const SurfaceSample& a, const SurfaceSample& b) {
      return a.cell != b.cell ? a.cell < b.cell : a.z_m < b.z_m;
    });
    merge();
    begin_.assign(grid.size() + 1, 0);
    for (const SurfaceSample& sample : samples_) ++begin_[sample.cell + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  }

  std::vector<SurfaceSample>& all() { return samples_; }
  std::size_t begin(std::size_t cell) const { return begin_[cell]; }
  std::size_t end(std::size_t cell) const { return begin_[cell + 1]; }

  bool is_walkable(std::size_t i) const { return samples_[i].is_gentle && has_free_height(i, kMinFree_m); }

  bool has_free_height(std::size_t i, double height_m) const {
    const bool is_last = i + 1 >= samples_.size() || samples_[i + 1].cell != samples_[i].cell;
    return is_last || double{samples_[i + 1].z_m} - double{samples_[i].z_m} >= height_m;
  }

  /// Calls `visit` with the index of each of the four neighbors of a cell.
  template <typename Visit>
  void for_neighbors(std::size_t cell, Visit visit) const {
    const auto width = static_cast<std::size_t>(grid_.width);
    if (cell % width > 0) visit(cell - 1);
    if (cell % width + 1 < width) visit(cell + 1);
    if (cell >= width) visit(cell - width);
    if (cell + width < grid_.size()) visit(cell + width);
  }

 private:
  void merge() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const SurfaceSample& next = samples_[i];
      if (kept > 0 && samples_[kept - 1].cell == next.cell &&
          double{next.z_m} - double{samples_[kept - 1].z_m} < kSame_m) {
        SurfaceSample& last = samples_[kept - 1];
        last.is_gentle |= next.is_gentle;
        last.faces_up |= next.faces_up;
        last.is_given |= next.is_given;
      } else {
        samples_[kept++] = next;
      }
    }
    samples_.resize(kept);
  }

  GridGeometry grid_;
  std::vector<SurfaceSample> samples_;
  std::vector<std::size_t> begin_;  ///< [cell]
};

/// Returns whether the triangles of a mesh face one side. They do not if neighbors, or two triangles with the same
/// corners, face opposite sides.
bool is_oriented(const Mesh& mesh) {
  const Mesh joined = welded(mesh);
  struct Edge {
    int low, high, opposite;
    bool is_reversed;
    auto key() const { return std::tie(low, high); }
  };
  std::vector<Edge> edges;
  edges.reserve(3 * joined.triangles.size());
  for (const std::array<int, 3>& t : joined.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t[(k + 2) % 3], a > b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
  std::size_t num_wrong = 0, num_shared = 0;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].key() == edges[begin].key()) ++end;
    if (end - begin < 2) continue;
    ++num_shared;
    const bool has_two = end - begin == 2;
    bool is_wrong = has_two && edges[begin].is_reversed == edges[begin + 1].is_reversed;
    for (std::size_t i = begin + 1; i < end; ++i)
      is_wrong |= edges[i].opposite == edges[begin].opposite && edges[i].is_reversed != edges[begin].is_reversed;
    num_wrong += is_wrong ? 1 : 0;
  }
  return static_cast<double>(num_wrong) <= kMaxWrongRatio * static_cast<double>(num_shared);
}

/// Connected walkable surface.
struct WalkableSurface {
  std::size_t count = 0;
  std::size_t num_up = 0;  ///< samples that face up; of a mesh that is not oriented, samples with `kStandingFree_m`
  std::size_t num_standing = 0;  ///< samples with `kStandingFree_m`
  std::size_t num_given = 0;     ///< samples of given surfaces
  double sum_z_m = 0.0;

  double mean_z_m() const { return sum_z_m / static_cast<double>(count); }
  bool faces_up() const { return 2 * num_up > count; }
  bool is_for_standing() const { return 2 * num_standing > count; }
};

/// Labels connected walkable surfaces. Top and underside of a slab stay apart, also with cells larger than the slab is
/// thick: walkable undersides are at least `kMinFree_m` below the top.
std::vector<WalkableSurface> label_surfaces(SurfaceSamples& samples, double rise_m, bool is_mesh_oriented) {
  std::vector<WalkableSurface> surfaces;
  std::vector<std::size_t> queue;
  for (std::size_t seed = 0; seed < samples.all().size(); ++seed) {
    if (samples.all()[seed].surface >= 0 || !samples.is_walkable(seed)) continue;
    const int label = static_cast<int>(surfaces.size());
    WalkableSurface surface;
    samples.all()[seed].surface = label;
    queue.assign(1, seed);
    while (!queue.empty()) {
      const std::size_t at = queue.back();
      const SurfaceSample here = samples.all()[at];
      queue.pop_back();
      ++surface.count;
      const bool is_standing = samples.has_free_height(at, kStandingFree_m);
      const bool is_up = is_mesh_oriented ? here.faces_up : is_standing;
      surface.num_up += is_up ? 1 : 0;
      surface.num_standing += is_standing ? 1 : 0;
      surface.num_given += here.is_given ? 1 : 0;
      surface.sum_z_m += double{here.z_m};
      samples.for_neighbors(here.cell, [&](std::size_t cell) {
        for (std::size_t i = samples.begin(cell); i < samples.end(cell); ++i) {
          SurfaceSample& next = samples.all()[i];
          const double max_rise_m = next.faces_up == here.faces_up ? rise_m : std::min(rise_m, 0.5 * kMinFree_m);
          const bool is_near = std::abs(double{next.z_m} - double{here.z_m}) <= max_rise_m;
          if (next.surface >= 0 || !is_near || !samples.is_walkable(i)) continue;
          next.surface = label;
          queue.push_back(i);
        }
      });
    }
    surfaces.push_back(surface);
  }
  return surfaces;
}

/// Returns the lowest height of the given surfaces at a point.
std::optional<double> given_height_m(const Mesh& given, const Eigen::Vector2d& p_m) {
  std::optional<double> lowest_m;
  for (const std::array<int, 3>& t : given.triangles) {
    const Eigen::Vector3d &a = given.vertices_m[static_cast<std::size_t>(t[0])],
                          &b = given.vertices_m[static_cast<std::size_t>(t[1])],
                          &c = given.vertices_m[static_cast<std::size_t>(t[2])];
    Eigen::Matrix2d sides;
    sides << (b - a).head<2>(), (c - a).head<2>();
    if (std::abs(sides.determinant()) < 1e-12) continue;
    const Eigen::Vector2d uv = sides.inverse() * (p_m - a.head<2>());
    if (uv.minCoeff() < 0.0 || uv.sum() > 1.0) continue;
    const double z_m = a.z() + uv.x() * (b - a).z() + uv.y() * (c - a).z();
    lowest_m = std::min(lowest_m.value_or(z_m), z_m);
  }
  return lowest_m;
}

/// Returns the label of the surface with the given sample whose height is nearest to `z_m`; -1 if there is none.
int given_surface_near(SurfaceSamples& samples, double z_m) {
  int nearest = -1;
  double min_distance_m = std::numeric_limits<double>::infinity();
  for (const SurfaceSample& sample : samples.all()) {
    const double distance_m = std::abs(double{sample.z_m} - z_m);
    if (!sample.is_given || sample.surface < 0 || distance_m >= min_distance_m) continue;
    min_distance_m = distance_m;
    nearest = sample.surface;
  }
  return nearest;
}

/// Lowest walkable surface at a point that faces up; the lowest one if none does. Beside the grid, the given surface at
/// the height of the point; none (-1) if the mesh covers it within the grid.
int surface_at(SurfaceSamples& samples, const std::vector<WalkableSurface>& surfaces, const GridGeometry& grid,
               const Mesh& given, const Eigen::Vector2d& start) {
  int lowest = -1;
  const Cell at = grid.cell_at(start);
  if (!grid.contains(at)) {
    if (const std::optional<double> z_m = given_height_m(given, start)) return given_surface_near(samples, *z_m);
  } else {
    const std::size_t cell =
        static_cast<std::size_t>(at.row) * static_cast<std::size_t>(grid.width) + static_cast<std::size_t>(at.col);
    int up = -1;
    double up_m = 0.0;
    for (std::size_t i = samples.begin(cell); i < samples.end(cell); ++i) {
      const int label = samples.all()[i].surface;
      if (label < 0) continue;
      const WalkableSurface& surface = surfaces[static_cast<std::size_t>(label)];
      const double z_m = double{samples.all()[i].z_m};
      if (up >= 0 && z_m - up_m > kMaxSlab_m) break;
      if (surface.faces_up() && surface.is_for_standing()) return label;
      if (up >= 0 && surface.is_for_standing()) return label;  // a slab whose triangles face inward
      if (up < 0 && surface.faces_up()) up = label, up_m = z_m;
      if (lowest < 0) lowest = label;
    }
    if (up >= 0) return up;
  }
  if (lowest >= 0) return lowest;
  throw InputError(fmt::format("--start {:g},{:g}: no walkable surface there", start.x(), start.y()));
}

/// Label of the lowest large surface; -1 without a large one. Surfaces with room for a robot come first, since the
/// underside of a slab whose triangles face inward faces up, then surfaces that face up.
int surface_by_rule(const std::vector<WalkableSurface>& surfaces, double cell_m2) {
  const auto is_large = [&](const WalkableSurface& s) {
    return static_cast<double>(s.count) * cell_m2 >= kMinGround_m2;
  };
  const auto exists = [&](const auto& condition) {
    return std::ranges::any_of(surfaces, [&](const WalkableSurface& s) { return is_large(s) && condition(s); });
  };
  const bool has_standing = exists([](const WalkableSurface& s) { return s.is_for_standing(); });
  const auto has_room = [&](const WalkableSurface& s) { return !has_standing || s.is_for_standing(); };
  const bool has_up = exists([&](const WalkableSurface& s) { return s.faces_up() && has_room(s); });
  const auto is_candidate = [&](const WalkableSurface& s) { return has_room(s) && (!has_up || s.faces_up()); };
  std::size_t largest = 0;
  for (const WalkableSurface& s : surfaces) {
    if (is_candidate(s)) largest = std::max(largest, s.count);
  }
  int best = -1;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const WalkableSurface& s = surfaces[i];
    if (!is_candidate(s) || !is_large(s)) continue;
    if (static_cast<double>(s.count) < kMinGroundRatio * static_cast<double>(largest)) continue;
    if (best < 0 || s.mean_z_m() < surfaces[static_cast<std::size_t>(best)].mean_z_m()) best = static_cast<int>(i);
  }
  return best;
}

/// Height of the floor that given surfaces form below at least half of the grid; none without one.
std::optional<double> given_floor_m(SurfaceSamples& samples, const GridGeometry& grid) {
  std::vector<double> lowest_m;
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    for (std::size_t i = samples.begin(cell); i < samples.end(cell); ++i) {
      if (!samples.all()[i].is_given) continue;
      lowest_m.push_back(double{samples.all()[i].z_m});
      break;
    }
  }
  if (2 * lowest_m.size() < grid.size()) return std::nullopt;
  std::ranges::nth_element(lowest_m, lowest_m.begin() + static_cast<std::ptrdiff_t>(lowest_m.size() / 2));
  return lowest_m[lowest_m.size() / 2];
}

/// Returns whether a surface is the top of an object of the mesh on a floor.
bool is_top_of_object(const WalkableSurface& surface, double floor_m, double cell_m2) {
  return surface.num_given == 0 && static_cast<double>(surface.count) * cell_m2 < kMaxTop_m2 &&
         surface.mean_z_m() - floor_m > kMinTop_m;
}

/// Gives cells without ground the height of a drop there, or that of the nearest ground.
void fill(SurfaceSamples& samples, double rise_m, std::vector<char>& is_known, Grid<float>& height_m) {
  std::vector<std::size_t> queue;
  for (std::size_t cell = 0; cell < is_known.size(); ++cell) {
    if (is_known[cell] != 0) queue.push_back(cell);
  }
  std::vector<float> nearest = height_m.values();
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const std::size_t from = queue[next];
    samples.for_neighbors(from, [&](std::size_t cell) {
      if (is_known[cell] != 0) return;
      is_known[cell] = 1;
      nearest[cell] = nearest[from];
      height_m.values()[cell] = nearest[from];
      queue.push_back(cell);
      float drop_m = -std::numeric_limits<float>::infinity();
      bool has_ground_above = false;
      for (std::size_t i = samples.begin(cell); i < samples.end(cell); ++i) {
        const SurfaceSample& sample = samples.all()[i];
        const double depth_m = double{nearest[from]} - double{sample.z_m};
        if (std::abs(depth_m) <= rise_m) has_ground_above = true;
        else if (depth_m > 0.0 && sample.surface >= 0) drop_m = sample.z_m;
      }
      if (!has_ground_above && std::isfinite(drop_m)) height_m.values()[cell] = drop_m;
    });
  }
}

}  // namespace

double GroundSurface::at(const Eigen::Vector2d& p_m) const { return interpolated(height_m, p_m); }

GroundSurface find_ground(const Mesh& mesh, const Mesh& given, const GridGeometry& grid,
                          const std::optional<Eigen::Vector2d>& start) {
  const double rise_m = grid.resolution_m, cell_m2 = grid.resolution_m * grid.resolution_m;
  SurfaceSamples samples(mesh, given, grid);
  const bool is_mesh_oriented = is_oriented(mesh);
  const std::vector<WalkableSurface> surfaces = label_surfaces(samples, 1.001 * rise_m, is_mesh_oriented);
  int chosen = start ? surface_at(samples, surfaces, grid, given, *start) : -1;
  if (chosen < 0) chosen = surface_by_rule(surfaces, cell_m2);
  GroundSurface ground;
  ground.height_m = Grid<float>(grid);
  const std::optional<double> floor_m = start ? std::nullopt : given_floor_m(samples, grid);
  if (floor_m && (chosen < 0 || is_top_of_object(surfaces[static_cast<std::size_t>(chosen)], *floor_m, cell_m2))) {
    ground.is_found = true;
    ground.is_ground.assign(grid.size(), 1);
    std::ranges::fill(ground.height_m.values(), static_cast<float>(*floor_m));
    return ground;
  }
  if (chosen < 0) {
    double lowest_m = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& vertex : mesh.vertices_m) lowest_m = std::min(lowest_m, vertex.z());
    std::fill(ground.height_m.values().begin(), ground.height_m.values().end(), static_cast<float>(lowest_m));
    return ground;
  }
  ground.is_found = true;
  ground.is_oriented = is_mesh_oriented;
  ground.faces_up = surfaces[static_cast<std::size_t>(chosen)].faces_up();
  std::vector<char> is_known(grid.size(), 0);
  for (const SurfaceSample& sample : samples.all()) {
    if (sample.surface != chosen || is_known[sample.cell] != 0) continue;
    is_known[sample.cell] = 1;
    ground.height_m.values()[sample.cell] = sample.z_m;
    ground.area_m2 += cell_m2;
    if (!sample.is_given) ground.own_area_m2 += cell_m2;
  }
  ground.is_ground = is_known;
  fill(samples, rise_m, is_known, ground.height_m);
  return ground;
}

}  // namespace patrol::importer
