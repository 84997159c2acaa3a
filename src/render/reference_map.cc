#include "render/reference_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "render/scene/offscreen.h"
#include "sim/lidar_scene.h"
#include "sim/mujoco.h"
#include "sim/robot_model.h"

namespace patrol::render {
namespace {

using Bounds = Eigen::AlignedBox3d;

/// Geom that intersects the slice.
struct CutGeom {
  int geom;
  Bounds bounds;  ///< in world
};

bool is_actor(const mjModel& model, int mocap_body, const std::vector<std::string>& actors) {
  const std::string_view body = sim::name_of(model, mjOBJ_BODY, mocap_body);
  return std::any_of(actors.begin(), actors.end(),
                     [&](const std::string& actor) { return body == actor || body.starts_with(actor + "_"); });
}

/// Flags of all bodies: true if a body stays where the world file has it.
std::vector<bool> static_bodies(const mjModel& model, const ReferenceMapSettings& settings) {
  std::vector<bool> is_static(static_cast<std::size_t>(model.nbody));
  for (int body = 0; body < model.nbody; ++body) {
    const int root = model.body_rootid[body];
    const bool is_mocap = model.body_mocapid[root] >= 0;
    const bool moves = is_mocap && (!settings.actors || is_actor(model, root, *settings.actors));
    is_static[static_cast<std::size_t>(body)] = is_mocap ? !moves : model.body_weldid[body] == 0;
  }
  return is_static;
}

bool lidar_can_hit(const mjModel& model, int geom) {
  const int group = model.geom_group[geom];
  return group == sim::kGroupLidarOnly || (group == sim::kGroupSolid && model.geom_rgba[4 * geom + 3] > 0.0f);
}

Bounds bounds_in_world(const mjModel& model, const mjData& data, int geom) {
  const mjtNum* local = model.geom_aabb + 6 * geom;  // center, half sizes
  const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>> R(data.geom_xmat + 9 * geom);
  const Eigen::Vector3d center =
      Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * geom) + R * Eigen::Map<const Eigen::Vector3d>(local);
  const Eigen::Vector3d half = R.cwiseAbs() * Eigen::Map<const Eigen::Vector3d>(local + 3);
  return {center - half, center + half};
}

std::vector<CutGeom> geoms_cut_at(const mjModel& model, const mjData& data, const std::vector<bool>& is_static,
                                  double height_m) {
  std::vector<CutGeom> cut;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!is_static[static_cast<std::size_t>(model.geom_bodyid[geom])] || !lidar_can_hit(model, geom)) continue;
    if (model.geom_type[geom] == mjGEOM_PLANE) continue;  // has no interior
    const Bounds bounds = bounds_in_world(model, data, geom);
    if (bounds.min().z() < height_m && bounds.max().z() > height_m) cut.push_back({geom, bounds});
  }
  return cut;
}

/// Grid aligned to the world's origin, so that maps of one world at different heights have matching cells.
GridGeometry geometry_around(const Bounds& bounds, const ReferenceMapSettings& settings) {
  const double r = settings.resolution_m;
  const auto first = [&](double low_m) { return std::floor((low_m - settings.margin_m) / r); };
  const auto last = [&](double high_m) { return std::ceil((high_m + settings.margin_m) / r); };
  const Eigen::Vector2d low(first(bounds.min().x()), first(bounds.min().y()));
  const Eigen::Vector2d high(last(bounds.max().x()), last(bounds.max().y()));
  return {.resolution_m = r,
          .width = static_cast<int>(high.x() - low.x()),
          .height = static_cast<int>(high.y() - low.y()),
          .origin_m = low * r};
}

/// MuJoCo scene with selected geoms only.
class SliceScene {
 public:
  explicit SliceScene(std::size_t max_geoms) {
    mjv_defaultScene(&scene_);
    mjv_makeScene(nullptr, &scene_, static_cast<int>(max_geoms));
    std::fill(std::begin(scene_.flags), std::end(scene_.flags), mjtByte{0});
  }
  ~SliceScene() { mjv_freeScene(&scene_); }
  SliceScene(const SliceScene&) = delete;
  SliceScene& operator=(const SliceScene&) = delete;

  void clear() { scene_.ngeom = 0; }

  void add(const mjModel& model, const mjData& data, int geom) {
    constexpr float kWhite[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    mjvGeom& added = scene_.geoms[scene_.ngeom++];
    mjv_initGeom(&added, model.geom_type[geom], model.geom_size + 3 * geom, data.geom_xpos + 3 * geom,
                 data.geom_xmat + 9 * geom, kWhite);
    if (model.geom_type[geom] == mjGEOM_MESH) added.dataid = 2 * model.geom_dataid[geom];
    if (model.geom_type[geom] == mjGEOM_HFIELD) added.dataid = model.geom_dataid[geom];
  }

  /// Renders the depth: rows from high y to low y, columns along the camera's right (+x looking down, -x looking up).
  void render(Offscreen& offscreen, const Eigen::Vector3d& center_m, double width_m, double depth_m, bool looks_down,
              bool front_faces_only, std::vector<float>& depth) {
    constexpr float kNear_m = 1.0f;
    const float ahead = looks_down ? -1.0f : 1.0f;
    const auto half_height = static_cast<float>(0.5 * width_m * offscreen.height() / offscreen.width());
    for (mjvGLCamera& camera : scene_.camera) {
      camera = {.pos = {static_cast<float>(center_m.x()), static_cast<float>(center_m.y()),
                        static_cast<float>(center_m.z()) - ahead * kNear_m},
                .forward = {0.0f, 0.0f, ahead},
                .up = {0.0f, 1.0f, 0.0f},
                .frustum_center = 0.0f,
                .frustum_width = static_cast<float>(0.5 * width_m),
                .frustum_bottom = -half_height,
                .frustum_top = half_height,
                .frustum_near = kNear_m,
                .frustum_far = kNear_m + static_cast<float>(depth_m),
                .orthographic = 1};
    }
    scene_.flags[mjRND_CULL_FACE] = front_faces_only ? 1 : 0;
    offscreen.render(scene_);
    offscreen.read_depth(depth);
  }

 private:
  mjvScene scene_{};
};

/// Computes the cells whose center is inside a solid.
Grid<std::uint8_t> render_solid(const mjModel& model, const mjData& data, const std::vector<CutGeom>& cut,
                                const GridGeometry& geometry, double height_m) {
  constexpr int kTile = 1000;          // cells; one pixel per cell
  constexpr float kSameDepth = 1e-5f;  // tolerance as a fraction of the depth range
  const int tile_width = std::min(kTile, geometry.width), tile_height = std::min(kTile, geometry.height);
  mjModel depth_only = model;  // shares the arrays; textures and a shadow map take time to load and are not used
  depth_only.ntex = 0;
  depth_only.vis.quality.shadowsize = 0;
  Offscreen offscreen(depth_only, tile_width, tile_height);
  SliceScene scene(cut.size());
  Bounds all;
  for (const CutGeom& geom : cut) all.extend(geom.bounds);

  Grid<std::uint8_t> solid(geometry);
  std::vector<float> front, nearest;
  for (int row0 = 0; row0 < geometry.height; row0 += tile_height) {
    for (int col0 = 0; col0 < geometry.width; col0 += tile_width) {
      const Eigen::Vector2d low = geometry.origin_m + geometry.resolution_m * Eigen::Vector2d(col0, row0);
      const Eigen::Vector2d size = geometry.resolution_m * Eigen::Vector2d(tile_width, tile_height);
      const Bounds tile(Eigen::Vector3d(low.x(), low.y(), height_m),
                        Eigen::Vector3d(low.x() + size.x(), low.y() + size.y(), height_m));
      scene.clear();
      bool is_empty = true;
      for (const CutGeom& geom : cut) {
        if (!tile.intersects(geom.bounds)) continue;
        scene.add(model, data, geom.geom);
        is_empty = false;
      }
      if (is_empty) continue;
      for (const bool looks_down : {true, false}) {
        const double depth_m = 0.1 + (looks_down ? height_m - all.min().z() : all.max().z() - height_m);
        scene.render(offscreen, tile.center(), size.x(), depth_m, looks_down, true, front);
        scene.render(offscreen, tile.center(), size.x(), depth_m, looks_down, false, nearest);
        const int rows = std::min(tile_height, geometry.height - row0);
        const int columns = std::min(tile_width, geometry.width - col0);
        for (int row = 0; row < rows; ++row) {
          const int first_pixel = (tile_height - 1 - row) * tile_width + (looks_down ? 0 : tile_width - 1);
          const int step = looks_down ? 1 : -1;
          std::uint8_t* cells = &solid.at({col0, row0 + row});
          for (int col = 0; col < columns; ++col) {
            const auto pixel = static_cast<std::size_t>(first_pixel + step * col);
            cells[col] |= static_cast<std::uint8_t>(nearest[pixel] < front[pixel] - kSameDepth);
          }
        }
      }
    }
  }
  return solid;
}

bool is_solid(const Grid<std::uint8_t>& solid, Cell cell) { return solid.contains(cell) && solid.at(cell) != 0; }

OccupancyGrid surface_of(const Grid<std::uint8_t>& solid) {
  OccupancyGrid map(solid.geometry(), kFree);
  const std::uint8_t* value = solid.values().data();
  for (int row = 0; row < solid.geometry().height; ++row) {
    for (int col = 0; col < solid.geometry().width; ++col) {
      if (*value++ == 0) continue;
      const bool is_inside = is_solid(solid, {col - 1, row}) && is_solid(solid, {col + 1, row}) &&
                             is_solid(solid, {col, row - 1}) && is_solid(solid, {col, row + 1});
      map.at({col, row}) = is_inside ? kUnknown : kOccupied;
    }
  }
  return map;
}

/// Marks the cells behind every surface crossed by rays along the center lines of rows and columns.
Grid<std::uint8_t> cast_surfaces(const mjModel& model, const mjData& data, const std::vector<bool>& is_static,
                                 const GridGeometry& geometry, double height_m) {
  constexpr double kStep_m = 1e-4;  // offset past a surface for the next cast
  sim::LidarScene lidar(model);
  lidar.update(data);
  Grid<std::uint8_t> hit(geometry);
  const auto cast_line = [&](Eigen::Vector3d origin, const Eigen::Vector3d& direction, double length_m) {
    while (length_m > 0.0) {
      const std::optional<sim::RayHit> found = lidar.cast(origin, direction, length_m, sim::kRayScenery);
      if (!found) return;
      origin += (found->distance_m + kStep_m) * direction;
      length_m -= found->distance_m + kStep_m;
      const Cell cell = geometry.cell_at(origin.head<2>());
      if (hit.contains(cell) && is_static[static_cast<std::size_t>(model.geom_bodyid[found->geom])]) hit.at(cell) = 1;
    }
  };
  const Eigen::Vector2d size = geometry.resolution_m * Eigen::Vector2d(geometry.width, geometry.height);
  for (int row = 0; row < geometry.height; ++row) {
    const double y = geometry.center_of({0, row}).y();
    cast_line({geometry.origin_m.x(), y, height_m}, Eigen::Vector3d::UnitX(), size.x());
  }
  for (int col = 0; col < geometry.width; ++col) {
    const double x = geometry.center_of({col, 0}).x();
    cast_line({x, geometry.origin_m.y(), height_m}, Eigen::Vector3d::UnitY(), size.y());
  }
  return hit;
}

/// True if `holds` is true for the cell or one of its eight neighbors.
template <typename Predicate>
bool any_near(Cell cell, Predicate holds) {
  for (int row = cell.row - 1; row <= cell.row + 1; ++row) {
    for (int col = cell.col - 1; col <= cell.col + 1; ++col) {
      if (holds(Cell{col, row})) return true;
    }
  }
  return false;
}

ReferenceMapCheck check_and_complete(OccupancyGrid& map, const Grid<std::uint8_t>& hit) {
  const OccupancyGrid rendered = map;
  const auto is_surface = [&](Cell cell) { return rendered.contains(cell) && rendered.at(cell) == kOccupied; };
  const auto is_hit = [&](Cell cell) { return hit.contains(cell) && hit.at(cell) != 0; };
  ReferenceMapCheck check;
  const std::int8_t* rendered_value = rendered.values().data();
  const std::uint8_t* hit_value = hit.values().data();
  for (int row = 0; row < map.geometry().height; ++row) {
    for (int col = 0; col < map.geometry().width; ++col) {
      const bool is_free = *rendered_value++ == kFree, is_missed = *hit_value++ == 0;
      if (is_free && is_missed) continue;
      const Cell cell{col, row};
      // Rays also hit surfaces inside overlapping objects; these do not belong to the map.
      const bool is_buried = rendered.at(cell) == kUnknown;
      if (!is_surface(cell) && (!is_hit(cell) || is_buried)) continue;
      ++check.num_checked;
      const bool is_found_by_both = is_surface(cell) ? any_near(cell, is_hit) : any_near(cell, is_surface);
      if (is_found_by_both) ++check.num_agreeing;
      if (is_hit(cell) && !is_found_by_both) {
        map.at(cell) = kOccupied;
        ++check.num_added;
      }
    }
  }
  return check;
}

}  // namespace

ReferenceMap reference_map(const mjModel& view, const ReferenceMapSettings& settings) {
  const sim::DataPtr data = sim::make_data(view);
  mj_kinematics(&view, data.get());
  const std::vector<bool> is_static = static_bodies(view, settings);
  const std::vector<CutGeom> cut = geoms_cut_at(view, *data, is_static, settings.height_m);
  Bounds bounds;
  ReferenceMap reference;
  if (cut.empty()) {
    if (settings.visited_m.empty())
      throw InputError(
          fmt::format("reference map: the world has no surface at a height of {:.2f} m", settings.height_m));
    for (const Eigen::Vector2d& p_m : settings.visited_m)
      bounds.extend(Eigen::Vector3d(p_m.x(), p_m.y(), settings.height_m));
    reference.map = OccupancyGrid(geometry_around(bounds, settings), kFree);
    return reference;
  }
  for (const CutGeom& geom : cut) bounds.extend(geom.bounds);
  const GridGeometry geometry = geometry_around(bounds, settings);

  reference.map = surface_of(render_solid(view, *data, cut, geometry, settings.height_m));
  reference.check =
      check_and_complete(reference.map, cast_surfaces(view, *data, is_static, geometry, settings.height_m));
  return reference;
}

}  // namespace patrol::render
