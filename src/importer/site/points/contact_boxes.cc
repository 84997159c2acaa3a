#include "importer/site/points/contact_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "importer/grid/cell_regions.h"

namespace patrol::importer {
namespace {

/// Marks the cells of the ground within a distance of measured ground.
Grid<char> near_measured(const ScannedGround& ground, double distance_m) {
  const GridGeometry& grid = ground.origin.geometry();
  Grid<char> measured(grid, 0);
  std::transform(ground.origin.values().begin(), ground.origin.values().end(), measured.values().begin(),
                 [](GroundOrigin origin) { return static_cast<char>(origin == GroundOrigin::kMeasured); });
  return dilated(measured, static_cast<int>(std::ceil(distance_m / grid.resolution_m)));
}

struct Voxel {
  std::array<int, 3> at = {};
  Eigen::AlignedBox3d bounds;
  double area_m2 = 0.0;
};

using VoxelKey = std::uint64_t;

VoxelKey key_of(const std::array<int, 3>& at) {
  constexpr int kBitsPerAxis = 21, kMiddle = 1 << 20;
  VoxelKey key = 0;
  for (const int axis : at)
    key = (key << kBitsPerAxis) | static_cast<VoxelKey>((axis + kMiddle) & ((1 << kBitsPerAxis) - 1));
  return key;
}

/// Removes groups of adjacent voxels whose surfaces together are too small for an obstacle.
void remove_specks(std::unordered_map<VoxelKey, Voxel>& voxels, double min_area_m2) {
  std::vector<VoxelKey> keys;
  for (const auto& [key, voxel] : voxels) keys.push_back(key);
  std::unordered_set<VoxelKey> visited;
  for (const VoxelKey first : keys) {
    if (!voxels.contains(first) || !visited.insert(first).second) continue;
    std::vector<VoxelKey> group = {first};
    double area_m2 = 0.0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      const Voxel& voxel = voxels.at(group[i]);
      area_m2 += voxel.area_m2;
      for (int k = 0; k < 27; ++k) {
        const VoxelKey next = key_of({voxel.at[0] + k % 3 - 1, voxel.at[1] + k / 3 % 3 - 1, voxel.at[2] + k / 9 - 1});
        if (voxels.contains(next) && visited.insert(next).second) group.push_back(next);
      }
    }
    if (area_m2 >= min_area_m2) continue;
    for (const VoxelKey key : group) voxels.erase(key);
  }
}

std::vector<Voxel> occupied_voxels(const std::vector<Patch>& patches, const ScannedGround& ground,
                                   const ContactBoxSettings& settings) {
  std::unordered_map<VoxelKey, Voxel> voxels;
  const Grid<char> reachable = near_measured(ground, settings.max_distance_m);
  for (const Patch& patch : patches) {
    if (patch.num_corners < 3) continue;
    double low_m = 1e9, high_m = -1e9;
    for (std::size_t i = 0; i < patch.num_corners; ++i) {
      const Eigen::Vector3d corner = patch.corners_m[i].cast<double>();
      const double above_m = corner.z() - ground.height_at(corner.head<2>());
      low_m = std::min(low_m, above_m);
      high_m = std::max(high_m, above_m);
    }
    if (low_m > settings.highest_m + 1.0 || high_m < settings.lowest_m) continue;
    const std::vector<Eigen::Vector3d> points = sample(patch, 0.4 * settings.voxel_m);
    const double area_m2 = patch.area_m2() / static_cast<double>(points.size());
    for (const Eigen::Vector3d& p : points) {
      const double above_m = p.z() - ground.height_at(p.head<2>());
      if (above_m < settings.lowest_m || above_m > settings.highest_m) continue;
      const Cell cell = reachable.geometry().cell_at(p.head<2>());
      if (!reachable.contains(cell) || reachable.at(cell) == 0) continue;
      std::array<int, 3> at{};
      for (int axis = 0; axis < 3; ++axis)
        at[static_cast<std::size_t>(axis)] = static_cast<int>(std::floor(p[axis] / settings.voxel_m));
      Voxel& voxel = voxels[key_of(at)];
      voxel.at = at;
      voxel.bounds.extend(p);
      voxel.area_m2 += area_m2;
    }
  }
  remove_specks(voxels, settings.min_group_area_m2);
  std::vector<Voxel> occupied;
  for (const auto& [key, voxel] : voxels) {
    if (voxel.area_m2 >= settings.min_area_m2) occupied.push_back(voxel);
  }
  std::sort(occupied.begin(), occupied.end(), [](const Voxel& a, const Voxel& b) { return a.at < b.at; });
  return occupied;
}

/// Box of joined voxels.
struct VoxelBox {
  std::array<int, 3> begin = {}, end = {};
  Eigen::AlignedBox3d bounds;
};

/// Joins boxes that follow each other along an axis, with at most `max_gap` voxels between them, and whose bounds along
/// the other axes differ by at most `tolerance_m`.
std::vector<VoxelBox> join_along(const std::vector<VoxelBox>& boxes, int axis, int max_gap, double tolerance_m) {
  constexpr int kMaxLength = 100;
  const auto one = static_cast<std::size_t>((axis + 1) % 3), two = static_cast<std::size_t>((axis + 2) % 3),
             along = static_cast<std::size_t>(axis);
  std::vector<VoxelBox> sorted = boxes;
  const auto key = [&](const VoxelBox& box) {
    return std::array<int, 6>{box.begin[one], box.end[one],     box.begin[two],
                              box.end[two],   box.begin[along], box.end[along]};
  };
  std::sort(sorted.begin(), sorted.end(), [&](const VoxelBox& a, const VoxelBox& b) { return key(a) < key(b); });
  std::vector<VoxelBox> joined;
  for (const VoxelBox& box : sorted) {
    if (!joined.empty()) {
      VoxelBox& last = joined.back();
      const auto is_alike = [&](std::size_t other) {
        const auto row = static_cast<Eigen::Index>(other);
        return last.begin[other] == box.begin[other] && last.end[other] == box.end[other] &&
               std::abs(last.bounds.min()[row] - box.bounds.min()[row]) <= tolerance_m &&
               std::abs(last.bounds.max()[row] - box.bounds.max()[row]) <= tolerance_m;
      };
      if (is_alike(one) && is_alike(two) && box.begin[along] - last.end[along] <= max_gap &&
          box.end[along] - last.begin[along] <= kMaxLength) {
        last.end[along] = box.end[along];
        last.bounds.extend(box.bounds);
        continue;
      }
    }
    joined.push_back(box);
  }
  return joined;
}

}  // namespace

std::vector<Eigen::AlignedBox3d> contact_boxes(const std::vector<Patch>& patches, const ScannedGround& ground,
                                               const ContactBoxSettings& settings) {
  std::vector<VoxelBox> boxes;
  for (const Voxel& voxel : occupied_voxels(patches, ground, settings)) {
    Eigen::AlignedBox3d bounds = voxel.bounds;
    for (int axis = 0; axis < 3; ++axis) {
      const double missing_m = settings.min_thickness_m - bounds.sizes()[axis];
      if (missing_m <= 0.0) continue;
      bounds.min()[axis] -= 0.5 * missing_m;
      bounds.max()[axis] += 0.5 * missing_m;
    }
    boxes.push_back({.begin = voxel.at, .end = {voxel.at[0] + 1, voxel.at[1] + 1, voxel.at[2] + 1}, .bounds = bounds});
  }
  constexpr int kMaxPasses = 4, kMaxGapUpward = 3;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const std::size_t before = boxes.size();
    boxes = join_along(boxes, 2, kMaxGapUpward, settings.tolerance_m);
    boxes = join_along(boxes, 0, 0, settings.tolerance_m);
    boxes = join_along(boxes, 1, 0, settings.tolerance_m);
    if (boxes.size() == before) break;
  }
  std::vector<Eigen::AlignedBox3d> bounds;
  for (const VoxelBox& box : boxes) bounds.push_back(box.bounds);
  return bounds;
}

}  // namespace patrol::importer
