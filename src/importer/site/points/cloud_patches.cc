#include "importer/site/points/cloud_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_set>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"

namespace patrol::importer {
namespace {

using CellKey = std::uint64_t;
constexpr double kFinest_m = 0.02;
constexpr int kKeyBits = 21;  // per axis

struct KeyedPoint {
  CellKey key;
  std::uint32_t point;
};

/// Returns the bits of a coordinate, with two zeros after each.
CellKey spread(CellKey value) {
  CellKey key = 0;
  for (int bit = 0; bit < kKeyBits; ++bit) key |= ((value >> bit) & 1u) << (3 * bit);
  return key;
}

CellKey gather(CellKey key) {
  CellKey value = 0;
  for (int bit = 0; bit < kKeyBits; ++bit) value |= ((key >> (3 * bit)) & 1u) << bit;
  return value;
}

Eigen::Vector3d position_of(const ScannerPoint& point) {
  return Eigen::Vector3f(point.x, point.y, point.z).cast<double>();
}

/// Cuts a polygon by the half space normal * p <= limit.
std::vector<Eigen::Vector3d> cut(const std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector3d& normal,
                                 double limit) {
  std::vector<Eigen::Vector3d> inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double over_a = normal.dot(a) - limit, over_b = normal.dot(b) - limit;
    if (over_a <= 0.0) inside.push_back(a);
    if ((over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0))
      inside.push_back(a + over_a / (over_a - over_b) * (b - a));
  }
  return inside;
}

/// Extent of points along the axes of a plane, from its center.
struct PlaneExtent {
  double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
};

class CloudOctree {
 public:
  CloudOctree(const std::vector<ScannerPoint>& points, const std::function<float(float)>& reflectivity,
              const std::string& source)
      : points_(points), reflectivity_(reflectivity) {
    Eigen::AlignedBox3d box;
    for (const ScannerPoint& point : points) box.extend(position_of(point));
    constexpr double kMaxExtent_m = kFinest_m * (1 << kKeyBits);
    if (points.size() < 3) throw InputError(source + ": has fewer than three points");
    if (box.sizes().maxCoeff() >= kMaxExtent_m) throw InputError(source + ": is larger than 40 km");
    corner_ = box.min();
    sorted_.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d at = (position_of(points[i]) - corner_) / kFinest_m;
      CellKey key = 0;
      for (int axis = 0; axis < 3; ++axis) key |= spread(static_cast<CellKey>(at[axis])) << axis;
      sorted_.push_back({key, static_cast<std::uint32_t>(i)});
    }
    std::sort(sorted_.begin(), sorted_.end(), [](const KeyedPoint& a, const KeyedPoint& b) {
      return a.key != b.key ? a.key < b.key : a.point < b.point;
    });
    choose_leaf();
    find_noise();
  }

  CloudPatches make() {
    constexpr double kLargest_m = 1.5;
    int top = leaf_;
    while (cell_m(top) < kLargest_m) ++top;
    visit_cells(0, sorted_.size(), top, [&](std::size_t begin, std::size_t end) { divide(begin, end, top); });
    return {
        .patches = std::move(patches_), .cell_m = cell_m(leaf_), .noise_m = noise_m_, .num_outliers = num_outliers_};
  }

 private:
  static double cell_m(int level) { return kFinest_m * static_cast<double>(CellKey{1} << level); }

  /// Calls `visit` with the range of each cell of a level.
  template <typename Visit>
  void visit_cells(std::size_t begin, std::size_t end, int level, Visit visit) const {
    while (begin < end) {
      const CellKey cell = sorted_[begin].key >> (3 * level);
      std::size_t next = begin + 1;
      while (next < end && sorted_[next].key >> (3 * level) == cell) ++next;
      visit(begin, next);
      begin = next;
    }
  }

  void choose_leaf() {
    constexpr std::size_t kMinPoints = 6;
    constexpr int kCoarsest = 5;
    for (leaf_ = 0; leaf_ < kCoarsest; ++leaf_) {
      std::vector<std::size_t> counts;
      visit_cells(0, sorted_.size(), leaf_, [&](std::size_t begin, std::size_t end) { counts.push_back(end - begin); });
      std::nth_element(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2), counts.end());
      if (counts[counts.size() / 2] >= kMinPoints) break;
    }
  }

  PointMoments moments_of(std::size_t begin, std::size_t end, const Eigen::Vector3d& center) const {
    PointMoments moments;
    for (std::size_t i = begin; i < end; ++i) moments.add(position_of(points_[sorted_[i].point]) - center);
    return moments;
  }

  FittedPlane plane_of(std::size_t begin, std::size_t end) const {
    // Relative to one of the points, for precision.
    const Eigen::Vector3d center = position_of(points_[sorted_[begin].point]);
    FittedPlane plane = fit_plane(moments_of(begin, end, center));
    plane.center += center;
    return plane;
  }

  void find_noise() {
    std::vector<double> stds;
    visit_cells(0, sorted_.size(), leaf_, [&](std::size_t begin, std::size_t end) {
      occupied_.insert(sorted_[begin].key >> (3 * leaf_));
      if (end - begin >= 6) stds.push_back(plane_of(begin, end).std_m[0]);
    });
    if (stds.empty()) return;
    std::nth_element(stds.begin(), stds.begin() + static_cast<std::ptrdiff_t>(stds.size() / 2), stds.end());
    noise_m_ = stds[stds.size() / 2];
  }

  bool has_neighbor(CellKey cell) const {
    std::array<CellKey, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = gather(cell >> axis);
    for (int k = 0; k < 27; ++k) {
      const std::array<int, 3> step = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
      if (k == 13) continue;
      CellKey other = 0;
      bool is_valid = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (step[axis] < 0 && at[axis] == 0) is_valid = false;
        other |= spread(at[axis] + static_cast<CellKey>(static_cast<std::int64_t>(step[axis]))) << axis;
      }
      if (is_valid && occupied_.contains(other)) return true;
    }
    return false;
  }

  void divide(std::size_t begin, std::size_t end, int level) {
    constexpr std::size_t kMinPoints = 3;
    if (end - begin < kMinPoints) {
      num_outliers_ += end - begin;
      return;
    }
    const FittedPlane plane = plane_of(begin, end);
    if (level > leaf_) {
      if (is_filled_plane(begin, end, level, plane)) {
        emit(begin, end, level, plane);
        return;
      }
      visit_cells(begin, end, level - 1, [&](std::size_t b, std::size_t e) { divide(b, e, level - 1); });
      return;
    }
    if (!has_neighbor(sorted_[begin].key >> (3 * leaf_))) {
      num_outliers_ += end - begin;
      return;
    }
    emit(begin, end, level, plane);
  }

  /// Returns whether nearly all points are on the plane and fill its part within the cell.
  bool is_filled_plane(std::size_t begin, std::size_t end, int level, const FittedPlane& plane) const {
    constexpr double kMinFlat_m = 0.004, kMinFilled = 0.85;
    const double flat_m = std::max(kMinFlat_m, 1.3 * noise_m_);
    if (plane.std_m[0] > flat_m) return false;
    const double step_m = 2.0 * cell_m(leaf_);
    std::set<std::array<int, 2>> filled;
    std::size_t num_off = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d p = plane.axes.transpose() * (position_of(points_[sorted_[i].point]) - plane.center);
      if (std::abs(p[0]) > 4.0 * flat_m) ++num_off;
      filled.insert({static_cast<int>(std::floor(p[1] / step_m)), static_cast<int>(std::floor(p[2] / step_m))});
    }
    if (100 * num_off > end - begin) return false;
    const Patch whole = patch_of(section(begin, level, plane));
    return static_cast<double>(filled.size()) * step_m * step_m >= kMinFilled * whole.area_m2();
  }

  /// Returns the polygon of the plane within the cell, slightly enlarged.
  std::vector<Eigen::Vector3d> section(std::size_t begin, int level, const FittedPlane& plane) const {
    constexpr double kOverlap_m = 0.002;
    const double size_m = cell_m(level);
    const CellKey cell = sorted_[begin].key >> (3 * level);
    Eigen::Vector3d low;
    for (int axis = 0; axis < 3; ++axis) low[axis] = corner_[axis] + size_m * static_cast<double>(gather(cell >> axis));
    std::vector<Eigen::Vector3d> polygon;
    for (const auto& [u, v] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
      polygon.push_back(plane.center + 2.0 * size_m * (u * plane.axes.col(1) + v * plane.axes.col(2)));
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
      polygon = cut(polygon, unit, low[axis] + size_m + kOverlap_m);
      polygon = cut(polygon, -unit, -low[axis] + kOverlap_m);
    }
    return polygon;
  }

  static Patch patch_of(const std::vector<Eigen::Vector3d>& polygon) {
    Patch patch;
    for (std::size_t i = 0; i < std::min(polygon.size(), patch.corners_m.size()); ++i)
      patch.corners_m[patch.num_corners++] = polygon[i].cast<float>();
    return patch;
  }

  void emit(std::size_t begin, std::size_t end, int level, const FittedPlane& plane) {
    std::vector<Eigen::Vector3d> polygon = section(begin, level, plane);
    float light = 0.0f;
    PlaneExtent extent;
    for (std::size_t i = begin; i < end; ++i) {
      light += points_[sorted_[i].point].intensity;
      const Eigen::Vector3d p = plane.axes.transpose() * (position_of(points_[sorted_[i].point]) - plane.center);
      for (const int axis : {0, 1}) {
        extent.low[axis] = std::min(extent.low[axis], p[axis + 1]);
        extent.high[axis] = std::max(extent.high[axis], p[axis + 1]);
      }
    }
    if (level == leaf_) {
      // A cell at the edge of a surface ends with its points.
      const double margin_m = 0.25 * cell_m(leaf_);
      for (const int axis : {0, 1}) {
        const Eigen::Vector3d along = plane.axes.col(axis + 1);
        const double middle = along.dot(plane.center);
        polygon = cut(polygon, along, middle + extent.high[axis] + margin_m);
        polygon = cut(polygon, -along, -middle - extent.low[axis] + margin_m);
      }
    }
    if (polygon.size() < 3) return;
    // Cutting can leave more corners than a patch has: divide the polygon.
    for (std::size_t first = 1; first + 1 < polygon.size();) {
      Patch patch;
      patch.corners_m[patch.num_corners++] = polygon[0].cast<float>();
      for (std::size_t i = first; i < std::min(first + 5, polygon.size()); ++i)
        patch.corners_m[patch.num_corners++] = polygon[i].cast<float>();
      first += 4;
      patch.reflectivity = reflectivity_(light / static_cast<float>(end - begin));
      patches_.push_back(patch);
    }
  }

  const std::vector<ScannerPoint>& points_;
  const std::function<float(float)>& reflectivity_;
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();
  std::vector<KeyedPoint> sorted_;  ///< points in ascending key order
  std::unordered_set<CellKey> occupied_;
  int leaf_ = 0;
  double noise_m_ = 0.0;
  std::vector<Patch> patches_;
  std::size_t num_outliers_ = 0;
};

/// Returns for each cell of the ground the nearest cell on which a person can stand, by a wave over the grid.
Grid<Cell> nearest_free(const std::vector<Patch>& patches, const ScannedGround& ground) {
  const GridGeometry& grid = ground.height_m.geometry();
  Grid<char> is_blocked(grid, 0);
  for (const Patch& patch : patches) {
    for (const Eigen::Vector3d& p : sample(patch, 0.7 * grid.resolution_m)) {
      const Cell cell = grid.cell_at(p.head<2>());
      if (!grid.contains(cell)) continue;
      const double above_m = p.z() - double{ground.height_m.at(cell)};
      if (above_m > 0.3 && above_m < 1.8) is_blocked.at(cell) = 1;
    }
  }
  constexpr Cell kNone{-1, -1};
  Grid<Cell> nearest(grid, kNone);
  std::vector<Cell> open;
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      const Cell cell{col, row};
      if (is_blocked.at(cell) != 0 || ground.origin.at(cell) != GroundOrigin::kMeasured) continue;
      nearest.at(cell) = cell;
      open.push_back(cell);
    }
  }
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Cell at = open[i];
    for (const Cell next :
         {Cell{at.col + 1, at.row}, Cell{at.col - 1, at.row}, Cell{at.col, at.row + 1}, Cell{at.col, at.row - 1}}) {
      if (!grid.contains(next) || !(nearest.at(next) == kNone)) continue;
      nearest.at(next) = nearest.at(at);
      open.push_back(next);
    }
  }
  return nearest;
}

}  // namespace

CloudPatches patches_of_cloud(const std::vector<ScannerPoint>& points,
                              const std::function<float(float intensity)>& reflectivity, const std::string& source) {
  CloudPatches found = CloudOctree(points, reflectivity, source).make();
  if (found.patches.empty()) {
    Eigen::AlignedBox3f box;
    for (const ScannerPoint& point : points) box.extend(Eigen::Vector3f(point.x, point.y, point.z));
    const Eigen::Vector3f size = points.empty() ? Eigen::Vector3f::Zero().eval() : box.sizes().eval();
    throw InputError(fmt::format(
        "{}: the points form no surface; they span {:.4g} x {:.4g} x {:.4g} m, --scale gives the meters per unit",
        source, size.x(), size.y(), size.z()));
  }
  return found;
}

void orient(std::vector<Patch>& patches, const ScannedGround& ground) {
  constexpr double kEye_m = 1.5;
  const GridGeometry& grid = ground.height_m.geometry();
  const Grid<Cell> nearest = nearest_free(patches, ground);
  for (Patch& patch : patches) {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < patch.num_corners; ++i) center += patch.corners_m[i].cast<double>();
    center /= patch.num_corners;
    Cell cell = grid.cell_at(center.head<2>());
    cell.col = std::clamp(cell.col, 0, grid.width - 1);
    cell.row = std::clamp(cell.row, 0, grid.height - 1);
    const Cell free = nearest.at(cell);
    if (free.col < 0) continue;
    const Eigen::Vector2d p = grid.center_of(free);
    const Eigen::Vector3d eye(p.x(), p.y(), double{ground.height_m.at(free)} + kEye_m);
    if (patch.area_normal().dot(eye - center) < 0.0)
      std::reverse(patch.corners_m.begin(), patch.corners_m.begin() + patch.num_corners);
  }
}

}  // namespace patrol::importer
