#include "importer/site/compiled_site.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "importer/site/enclosing_solid.h"
#include "importer/site/floor_rays.h"
#include "sim/geom_box.h"
#include "sim/ground.h"
#include "sim/mujoco.h"

namespace patrol::importer {
namespace {

using GeomRotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Bounding box of a geom along its own axes, seen from above.
struct Outline {
  Eigen::Vector2d center_m;
  std::array<Eigen::Vector2d, 2> axes;  ///< horizontal unit vectors
  std::array<double, 2> half_m;         ///< half sizes along the axes

  double area_m2() const { return 4.0 * half_m[0] * half_m[1]; }
};

Outline outline_of(const mjModel& model, const mjData& data, int geom) {
  const Eigen::Map<const GeomRotation> R(data.geom_xmat + 9 * geom);
  const Eigen::Map<const Eigen::Vector3d> position(data.geom_xpos + 3 * geom), middle(model.geom_aabb + 6 * geom),
      half(model.geom_aabb + 6 * geom + 3);
  Eigen::Index upright = 0;
  R.row(2).cwiseAbs().maxCoeff(&upright);
  const Eigen::Index first = (upright + 1) % 3, second = (upright + 2) % 3;
  return {.center_m = (position + R * middle).head<2>(),
          .axes = {R.col(first).head<2>().normalized(), R.col(second).head<2>().normalized()},
          .half_m = {half[first], half[second]}};
}

std::string geom_text(const mjModel& model, int geom) {
  const std::string_view name = sim::name_of(model, mjOBJ_GEOM, geom);
  return name.empty() ? fmt::format("geom {}", geom) : std::string(name);
}

/// Whether a site has a surface with contact that can be its ground. The top of an object is none: it is smaller than
/// 20 m2 and more than 0.3 m above the lowest point.
bool has_ground(const mjModel& model, const mjData& data) {
  constexpr double kMaxObject_m2 = 20.0, kMin_m2 = 1.0, kMaxAbove_m = 0.3, kLevel = 0.7;
  double lowest_m = std::numeric_limits<double>::infinity();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (is_touchable(model, geom) && model.geom_type[geom] != mjGEOM_PLANE)
      lowest_m = std::min(lowest_m, sim::geom_box(model, data, geom).min().z());
  }
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!is_touchable(model, geom)) continue;
    if (model.geom_type[geom] == mjGEOM_HFIELD) return true;
    if (model.geom_type[geom] == mjGEOM_PLANE) {
      if (data.geom_xmat[9 * geom + 8] > kLevel) return true;
      continue;
    }
    const double area_m2 = outline_of(model, data, geom).area_m2();
    if (area_m2 >= kMaxObject_m2) return true;
    if (area_m2 >= kMin_m2 && sim::geom_box(model, data, geom).max().z() - lowest_m <= kMaxAbove_m) return true;
  }
  return false;
}

/// Finds shapes that end below the lidar of a robot.
class LowObstacles {
 public:
  LowObstacles(const mjModel& model, const mjData& data, const sim::GroundSettings& ground, double lidar_height_m)
      : model_(model),
        data_(data),
        rays_(model),
        ground_(ground, model),
        max_curb_m_(ground.max_curb_m),
        lidar_height_m_(lidar_height_m) {}

  /// Height of a shape above the floor beside it; none unless it is an obstacle that the lidar cannot measure.
  std::optional<double> height_m(int geom) const {
    const int type = model_.geom_type[geom];
    if (!is_touchable(model_, geom) || type == mjGEOM_PLANE || type == mjGEOM_HFIELD) return std::nullopt;
    if (ground_.class_of(geom) == sim::SurfaceClass::kGround) return std::nullopt;
    const Outline outline = outline_of(model_, data_, geom);
    const double top_m = sim::geom_box(model_, data_, geom).max().z();
    const std::optional<double> floor_m = floor_beside_m(outline, top_m);
    if (!floor_m || top_m - *floor_m <= max_curb_m_ || top_m - *floor_m >= lidar_height_m_) return std::nullopt;
    return is_seen_beside(outline, *floor_m + lidar_height_m_) ? std::nullopt : std::optional(top_m - *floor_m);
  }

 private:
  /// Calls `visit` with points at a distance from the sides of an outline, at most `spacing_m` apart along them.
  template <typename Visit>
  static void visit_sides(const Outline& outline, double distance_m, double spacing_m, Visit visit) {
    constexpr int kMaxPoints = 20;
    for (const std::size_t axis : {0u, 1u}) {
      const std::size_t along = 1 - axis;
      const double reach_m = outline.half_m[axis] + distance_m, half_m = outline.half_m[along];
      const int num = std::clamp(static_cast<int>(std::ceil(2.0 * half_m / spacing_m)), 1, kMaxPoints);
      for (int i = 0; i < num; ++i) {
        const Eigen::Vector2d p = outline.center_m + ((2.0 * i + 1.0) / num - 1.0) * half_m * outline.axes[along];
        for (const double side : {-1.0, 1.0}) visit(Eigen::Vector2d(p + side * reach_m * outline.axes[axis]));
      }
    }
  }

  /// Height of the lowest floor beside an outline. It may be a higher one if the shape is above the lidar already.
  std::optional<double> floor_beside_m(const Outline& outline, double top_m) const {
    constexpr double kFree_m = 1.5;  // a robot fits below
    std::optional<double> floor_m;
    for (const double distance_m : {0.3, 1.0}) {
      visit_sides(outline, distance_m, std::numeric_limits<double>::infinity(), [&](const Eigen::Vector2d& p) {
        if (floor_m && top_m - *floor_m >= lidar_height_m_) return;
        const std::optional<double> height_m = rays_.lowest_floor_m(p, kFree_m);
        if (height_m) floor_m = std::min(*height_m, floor_m.value_or(*height_m));
      });
    }
    return floor_m;
  }

  /// Whether lidars see a surface near each point beside an outline.
  bool is_seen_beside(const Outline& outline, double height_m) const {
    constexpr double kDistance_m = 0.03, kSpacing_m = 0.5, kNear_m = 0.25;
    bool is_seen = true;
    visit_sides(outline, kDistance_m, kSpacing_m, [&](const Eigen::Vector2d& p) {
      if (!is_seen) return;
      is_seen = false;
      for (const Eigen::Vector2d& axis : outline.axes) {
        for (const double side : {-1.0, 1.0}) {
          const Eigen::Vector3d direction(side * axis.x(), side * axis.y(), 0.0);
          is_seen |= rays_.distance_m({p.x(), p.y(), height_m}, direction, kNear_m).has_value();
        }
      }
    });
    return is_seen;
  }

  const mjModel& model_;
  const mjData& data_;
  FloorRays rays_;
  sim::Ground ground_;
  double max_curb_m_, lidar_height_m_;
};

std::optional<Assumption> low_obstacle_row(const mjModel& model, const mjData& data, const ImportedSite& site) {
  constexpr std::size_t kExamples = 3;
  const LowObstacles obstacles(model, data, site.ground, *site.lidar_height_m);
  int num = 0;
  double max_m = 0.0;
  std::vector<std::string> examples;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const std::optional<double> height_m = obstacles.height_m(geom);
    if (!height_m) continue;
    ++num;
    max_m = std::max(max_m, *height_m);
    if (examples.size() < kExamples) examples.push_back(geom_text(model, geom));
  }
  if (num == 0) return std::nullopt;
  return Assumption{"low obstacles",
                    fmt::format("{} with contact below the lidar of {} ({:.2f} m), which does not measure them, up to "
                                "{:.2f} m high: {}{}",
                                num == 1 ? "1 shape" : fmt::format("{} shapes", num), site.robot, *site.lidar_height_m,
                                max_m, patrol::join(examples, ", "), num > static_cast<int>(kExamples) ? " ..." : ""),
                    "--robot; mounts in the settings of the robot"};
}

}  // namespace

void check_coordinates(const mjModel& model, const std::string& source) {
  const sim::DataPtr data = sim::make_data(model);
  mj_kinematics(&model, data.get());
  for (int geom = 0; geom < model.ngeom; ++geom) {
    double max_m = Eigen::Map<const Eigen::Vector3d>(data->geom_xpos + 3 * geom).cwiseAbs().maxCoeff();
    if (model.geom_type[geom] != mjGEOM_PLANE) {
      const Eigen::AlignedBox3d box = sim::geom_box(model, *data, geom);
      max_m = std::max({max_m, box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()});
    }
    if (max_m > kMaxCoordinate_m)
      throw InputError(fmt::format("{}: {}: {}", source, geom_text(model, geom), far_text(max_m)));
  }
}

std::vector<Assumption> rows_of_compiled(const mjModel& model, const ImportedSite& site) {
  const sim::DataPtr data = sim::make_data(model);
  mj_kinematics(&model, data.get());
  std::vector<Assumption> rows;
  if (!has_ground(model, *data))
    rows.push_back({"no ground",
                    "no plane, height field or level shape has contact below the objects: runs are refused without "
                    "ground below the start",
                    "the file"});
  if (site.lidar_height_m) {
    if (std::optional<Assumption> row = low_obstacle_row(model, *data, site)) rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace patrol::importer
