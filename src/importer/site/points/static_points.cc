#include "importer/site/points/static_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

#include "importer/site/points/near_gaps.h"
#include "importer/site/points/point_evidence.h"

namespace patrol::importer {
namespace {

constexpr int kMaxRun_px = 64;
constexpr std::array<std::array<int, 2>, 8> kAround = {
    {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};

/// Returns whether a beam met two surfaces: its range continues to neither neighbor along a row or a column and is
/// between theirs.
bool is_mixed(const Panorama& scan, Pixel pixel) {
  const auto is_between = [&](Pixel a, Pixel b) {
    const float low = std::min(scan.range_m(a), scan.range_m(b)), high = std::max(scan.range_m(a), scan.range_m(b));
    return low > 0.0f && low < scan.range_m(pixel) && scan.range_m(pixel) < high;
  };
  if (!scan.is_connected_left(pixel) && !scan.is_connected_right(pixel) &&
      is_between({scan.wrapped(pixel.col - 1), pixel.row}, {scan.wrapped(pixel.col + 1), pixel.row}))
    return true;
  return pixel.row > 0 && pixel.row + 1 < scan.rows() && !scan.is_connected_down(pixel) &&
         !scan.is_connected_up(pixel) && is_between({pixel.col, pixel.row - 1}, {pixel.col, pixel.row + 1});
}

void mark_outliers(Panorama& scan) {
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) {
      const Pixel pixel{col, row};
      const float range = scan.range_m(pixel);
      if (range > 0.0f && is_mixed(scan, pixel)) scan.state(pixel) |= kPixelOutlier;
      if (range <= 0.0f || scan.is_connected_right(pixel) || scan.is_connected_left(pixel) ||
          scan.is_connected_up(pixel) || scan.is_connected_down(pixel))
        continue;
      const double reach_m = 3.0 * scan.step_rad() * double{range} + 0.004;
      const bool is_lone = std::none_of(kAround.begin(), kAround.end(), [&](const auto& step) {
        const Pixel other{scan.wrapped(col + step[0]), row + step[1]};
        return scan.contains_row(other.row) && scan.range_m(other) > 0.0f &&
               std::abs(double{scan.range_m(other)} - double{range}) < reach_m;
      });
      if (is_lone) scan.state(pixel) |= kPixelOutlier;
    }
  }
}

/// Extents of the connected runs through each pixel, along rows and columns: the larger of the distance between the
/// ends of the run, which on a surface at a flat angle is that along the surface, and its width across the beams, of at
/// most kMaxRun_px pixels.
class Runs {
 public:
  explicit Runs(const Panorama& scan) : rows_(static_cast<std::size_t>(scan.rows())) {
    const std::size_t size = static_cast<std::size_t>(scan.columns()) * rows_;
    along_row_m_.assign(size, 0.0f);
    along_column_m_.assign(size, 0.0f);
    for (int row = 0; row < scan.rows(); ++row) {
      for (int col = 0; col < scan.columns();) {
        int end = col + 1;
        while (end < scan.columns() && scan.is_connected_right({end - 1, row})) ++end;
        const double length_m = (scan.point({end - 1, row}) - scan.point({col, row})).norm(),
                     angle_rad = scan.column_angle_rad(row) * std::min(end - col, kMaxRun_px);
        for (int c = col; c < end; ++c) {
          along_row_m_[index({c, row})] =
              static_cast<float>(std::max(length_m, angle_rad * double{scan.range_m({c, row})}));
        }
        col = end;
      }
    }
    for (int col = 0; col < scan.columns(); ++col) {
      for (int row = 0; row < scan.rows();) {
        int end = row + 1;
        while (end < scan.rows() && scan.is_connected_up({col, end - 1})) ++end;
        const double length_m = (scan.point({col, end - 1}) - scan.point({col, row})).norm(),
                     angle_rad = scan.step_rad() * std::min(end - row, kMaxRun_px);
        for (int r = row; r < end; ++r) {
          along_column_m_[index({col, r})] =
              static_cast<float>(std::max(length_m, angle_rad * double{scan.range_m({col, r})}));
        }
        row = end;
      }
    }
  }

  /// Returns the smaller extent of the surface through a pixel, m.
  double width_m(Pixel pixel) const {
    const std::size_t at = index(pixel);
    return double{std::min(along_row_m_[at], along_column_m_[at])};
  }

 private:
  std::size_t index(Pixel pixel) const {
    return static_cast<std::size_t>(pixel.col) * rows_ + static_cast<std::size_t>(pixel.row);
  }

  std::size_t rows_;
  std::vector<float> along_row_m_, along_column_m_;
};

/// Sets kPixelObserved, kPixelCovered, and kPixelMoving for pixels with evidence of their own.
void compare(std::vector<Panorama>& scans, std::size_t i) {
  Panorama& scan = scans[i];
  const Runs runs(scan);
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) {
      const Pixel pixel{col, row};
      if (scan.range_m(pixel) <= 0.0f || scan.has(pixel, kPixelOutlier)) continue;
      const Eigen::Vector3d normal = scan.normal(pixel);
      const double cosine = std::abs(normal.dot(scan.direction(pixel)));
      const SeenPoint seen{.position = scan.point(pixel),
                           .normal = normal,
                           .spacing_m = spacing_on_surface_m(double{scan.range_m(pixel)}, scan.step_rad(), cosine),
                           .width_m = runs.width_m(pixel),
                           .footprint_m = scan.step_rad() * double{scan.range_m(pixel)}};
      bool is_free = false, is_observed = false, is_covered = false;
      for (std::size_t k = 0; k < scans.size() && !(is_covered && is_observed); ++k) {
        if (k == i) continue;
        const Evidence evidence = evidence_of(scans[k], seen);
        is_free = is_free || evidence == Evidence::kFree;
        is_observed = is_observed || evidence == Evidence::kObserved || evidence == Evidence::kCovered;
        is_covered = is_covered || evidence == Evidence::kCovered;
      }
      if (is_observed) scan.state(pixel) |= kPixelObserved;
      if (is_covered) scan.state(pixel) |= kPixelCovered;
      if (is_free && !is_observed) scan.state(pixel) |= kPixelMoving;
    }
  }
}

/// Removes the state kPixelMoving where less than most of the surface around a pixel has it: along rows and columns
/// within a distance.
void erode_moving(Panorama& scan) {
  constexpr double kReach_m = 0.1, kMinFraction = 0.6;
  constexpr int kMinReach_px = 2, kMaxReach_px = 12;
  std::vector<Pixel> rejected;
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) {
      const Pixel pixel{col, row};
      if (!scan.has(pixel, kPixelMoving)) continue;
      const int reach = std::clamp(static_cast<int>(kReach_m / (scan.step_rad() * double{scan.range_m(pixel)})),
                                   kMinReach_px, kMaxReach_px);
      int num_seen = 0, num_moving = 0;
      const auto look = [&](Pixel other, bool is_connected) {
        if (!is_connected) return false;
        ++num_seen;
        num_moving += scan.has(other, kPixelMoving) ? 1 : 0;
        return true;
      };
      Pixel at = pixel;
      for (int k = 0; k < reach; ++k) {
        const Pixel next{scan.wrapped(at.col + 1), at.row};
        if (!look(next, scan.is_connected_right(at))) break;
        at = next;
      }
      at = pixel;
      for (int k = 0; k < reach; ++k) {
        const Pixel next{scan.wrapped(at.col - 1), at.row};
        if (!look(next, scan.is_connected_left(at))) break;
        at = next;
      }
      at = pixel;
      for (int k = 0; k < reach; ++k) {
        const Pixel next{at.col, at.row + 1};
        if (!look(next, scan.is_connected_up(at))) break;
        at = next;
      }
      at = pixel;
      for (int k = 0; k < reach; ++k) {
        const Pixel next{at.col, at.row - 1};
        if (!look(next, scan.is_connected_down(at))) break;
        at = next;
      }
      if (num_moving < kMinFraction * num_seen) rejected.push_back(pixel);
    }
  }
  for (const Pixel pixel : rejected) scan.state(pixel) &= static_cast<std::uint8_t>(~kPixelMoving);
}

/// Extends moving objects to neighbors at similar ranges, within a distance, that no other scan observes.
void grow_moving(Panorama& scan) {
  constexpr double kReach_m = 0.5, kMaxJump_m = 0.1;
  struct Front {
    Pixel pixel;
    int steps;
  };
  std::vector<Front> open;
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) {
      if (scan.has({col, row}, kPixelMoving)) open.push_back({{col, row}, 0});
    }
  }
  const auto visit = [&](Pixel from, Pixel pixel, int steps) {
    if (!scan.contains_row(pixel.row) || !scan.is_usable(pixel) || scan.has(pixel, kPixelObserved)) return;
    const double range_m = double{scan.range_m(pixel)};
    if (std::abs(double{scan.range_m(from)} - range_m) > kMaxJump_m || steps * scan.step_rad() * range_m > kReach_m)
      return;
    scan.state(pixel) |= kPixelMoving;
    open.push_back({pixel, steps});
  };
  for (std::size_t i = 0; i < open.size(); ++i) {
    const auto [at, steps] = open[i];
    visit(at, {scan.wrapped(at.col + 1), at.row}, steps + 1);
    visit(at, {scan.wrapped(at.col - 1), at.row}, steps + 1);
    visit(at, {at.col, at.row + 1}, steps + 1);
    visit(at, {at.col, at.row - 1}, steps + 1);
  }
}

/// Extends moving objects downward along the same surface if it does not face upward: at its foot, other scans observe
/// the ground at nearly the same range.
void remove_feet(Panorama& scan) {
  constexpr double kReach_m = 0.2, kSteep = 0.6;
  for (int col = 0; col < scan.columns(); ++col) {
    double reached_m = 0.0;
    for (int row = scan.rows() - 2; row >= 0; --row) {
      const Pixel pixel{col, row};
      if (scan.has(pixel, kPixelMoving)) {
        reached_m = 0.0;
        continue;
      }
      if (!scan.is_usable(pixel) || !scan.has({col, row + 1}, kPixelMoving) || !scan.is_connected_up(pixel)) continue;
      reached_m += scan.step_rad() * double{scan.range_m(pixel)};
      if (reached_m < kReach_m && scan.normal(pixel).z() < kSteep) scan.state(pixel) |= kPixelMoving;
    }
  }
}

using VoxelIndex = std::array<int, 3>;

/// Removes narrow strips of points next to large moving objects, such as those of a side at a flat angle, of which each
/// column of beams meets another part: too narrow to be looked through, not connected to the object, and observed by no
/// other scan. Strips that continue each other follow up to a distance from the object.
void remove_strips_at_moving(Panorama& scan) {
  constexpr double kVoxel_m = 1.0, kMaxWidth_m = 0.1;
  constexpr int kMinPoints = 300, kMaxSteps = 4;
  const auto voxel_of = [&](Pixel pixel) {
    const Eigen::Vector3d p = scan.point(pixel) / kVoxel_m;
    return VoxelIndex{static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                      static_cast<int>(std::floor(p.z()))};
  };
  const Runs runs(scan);
  std::map<VoxelIndex, int> num_moving;
  std::map<VoxelIndex, std::vector<Pixel>> strips;
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) {
      const Pixel pixel{col, row};
      if (scan.has(pixel, kPixelMoving)) {
        ++num_moving[voxel_of(pixel)];
      } else if (scan.is_usable(pixel) && !scan.has(pixel, kPixelObserved) && runs.width_m(pixel) < kMaxWidth_m) {
        strips[voxel_of(pixel)].push_back(pixel);
      }
    }
  }
  std::vector<VoxelIndex> front;
  for (const auto& [voxel, count] : num_moving) {
    if (count >= kMinPoints) front.push_back(voxel);
  }
  for (int step = 0; step < kMaxSteps && !front.empty(); ++step) {
    std::vector<VoxelIndex> next;
    for (const VoxelIndex& at : front) {
      for (int k = 0; k < 27; ++k) {
        const auto found = strips.find({at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1});
        if (found == strips.end()) continue;
        for (const Pixel pixel : found->second) scan.state(pixel) |= kPixelMoving;
        next.push_back(found->first);
        strips.erase(found);
      }
    }
    front = std::move(next);
  }
}

}  // namespace

StaticPointCounts find_static_points(std::vector<Panorama>& scans, const std::function<void(std::size_t)>& on_scan) {
  for (Panorama& scan : scans) {
    mark_outliers(scan);
    mark_near_gaps(scan);
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    on_scan(i);
    compare(scans, i);
  }
  StaticPointCounts counts;
  for (Panorama& scan : scans) {
    erode_moving(scan);
    grow_moving(scan);
    remove_feet(scan);
    remove_strips_at_moving(scan);
    for (int col = 0; col < scan.columns(); ++col) {
      for (int row = 0; row < scan.rows(); ++row) {
        const Pixel pixel{col, row};
        counts.num_points += scan.range_m(pixel) > 0.0f ? 1 : 0;
        counts.num_outliers += scan.has(pixel, kPixelOutlier) ? 1 : 0;
        counts.num_moving += scan.has(pixel, kPixelMoving) ? 1 : 0;
      }
    }
  }
  return counts;
}

}  // namespace patrol::importer
