#include "importer/site/points/static_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

#include "importer/site/points/near_gaps.h"

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

/// Evidence of another scan about a point.
enum class Evidence : std::uint8_t { kNone, kFree, kObserved, kCovered };

struct SeenPoint {
  Eigen::Vector3d position, normal;
  double spacing_m;    ///< distance between the beams of its own scan on the surface
  double width_m;      ///< smaller extent of its surface
  double footprint_m;  ///< distance between the beams of its own scan across them
};

/// Mean distance between beams on a surface: the geometric mean along both directions.
double spacing_on_surface_m(double range_m, double step_rad, double cosine) {
  return range_m * step_rad / std::sqrt(std::max(cosine, 0.05));
}

constexpr double kMaxReturnRange_m = 45.0;  // to which beams without a return count as free

/// Beams of another scan around a point: its pixel and the eight around it.
struct Neighborhood {
  double nearest_m = 1e9;        ///< smallest range
  double nearest_point_m = 1e9;  ///< distance of the nearest usable point at the range of the seen one
  Pixel nearest;                 ///< pixel of this point
  int num_empty = 0;             ///< number of beams without a return
  bool is_blocked = false;       ///< one of these is blocked
  bool is_observed = false;      ///< a beam has the range of the seen point
};

Neighborhood neighborhood_of(const Panorama& other, const Pixel& center, const SeenPoint& seen, double distance_m,
                             double tolerance_m) {
  Neighborhood around{.nearest = center};
  for (int dc = -1; dc <= 1; ++dc) {
    for (int dr = -1; dr <= 1; ++dr) {
      const Pixel pixel{other.wrapped(center.col + dc), center.row + dr};
      const double range_m = double{other.range_m(pixel)};
      if (range_m <= 0.0) {
        ++around.num_empty;
        around.is_blocked = around.is_blocked || other.has(pixel, kPixelBlocked);
        continue;
      }
      around.nearest_m = std::min(around.nearest_m, range_m);
      if (std::abs(range_m - distance_m) > tolerance_m) continue;
      around.is_observed = true;
      if (!other.is_usable(pixel)) continue;
      const double off_m = (other.point(pixel) - seen.position).norm();
      if (off_m >= around.nearest_point_m) continue;
      around.nearest_point_m = off_m;
      around.nearest = pixel;
    }
  }
  return around;
}

/// Returns the evidence of the surface of another scan at its pixel: kObserved or kCovered on this surface, kNone
/// beside it. At a flat angle the ranges of neighbors differ, therefore by the distance from its plane.
Evidence evidence_of_plane(const Panorama& other, const Pixel& center, const SeenPoint& seen, double distance_m,
                           double tolerance_m) {
  const double center_m = double{other.range_m(center)};
  if (center_m <= 0.0 || std::abs(center_m - distance_m) >= 0.1 * distance_m || !other.is_usable(center))
    return Evidence::kNone;
  const Eigen::Vector3d normal = other.normal(center), p = other.point(center);
  const double off_m = std::abs(normal.dot(seen.position - p));
  const double cosine = std::max(0.08, std::abs(normal.dot(seen.position - other.origin())) / distance_m);
  const bool is_near = (seen.position - p).norm() < 1.5 * other.step_rad() * distance_m / cosine;
  if (!is_near || off_m >= tolerance_m) return Evidence::kNone;
  const bool is_closer = spacing_on_surface_m(center_m, other.step_rad(), cosine) < 0.75 * seen.spacing_m;
  const bool is_same = off_m < 0.008 + 0.0005 * distance_m && normal.dot(seen.normal) > 0.7;
  return is_same && is_closer ? Evidence::kCovered : Evidence::kObserved;
}

/// Returns whether another scan has a point near by with beams much closer together. For surfaces that are not flat,
/// such as a thin post.
bool is_covered_by_point(const Panorama& other, const Neighborhood& around, const SeenPoint& seen, double footprint_m) {
  constexpr double kThin_m = 0.3, kAlike = 0.3;
  if (around.nearest_point_m >= std::max(0.03, 0.7 * seen.spacing_m)) return false;
  if (seen.width_m < kThin_m) return 1.5 * footprint_m < seen.spacing_m;
  return 1.05 * footprint_m < seen.footprint_m && other.normal(around.nearest).dot(seen.normal) > kAlike;
}

/// Returns whether beams of another scan pass through a point: kFree or kNone. At least one of three neighboring beams
/// would meet its surface; beams along it pass at one of its sides.
Evidence evidence_of_free_space(const Neighborhood& around, const SeenPoint& seen, double distance_m, double cosine,
                                double footprint_m) {
  constexpr double kMinCosine = 0.1, kMinReturnCosine = 0.35;
  if (around.is_blocked || 1.15 * footprint_m > seen.width_m || cosine < kMinCosine) return Evidence::kNone;
  const bool would_return = cosine > kMinReturnCosine && distance_m < kMaxReturnRange_m && distance_m > 1.0;
  if (around.num_empty == 9) return would_return ? Evidence::kFree : Evidence::kNone;
  if (around.num_empty > 0 && !would_return) return Evidence::kNone;
  const double margin_m = 0.08 + 0.01 * distance_m;
  return around.nearest_m > distance_m + margin_m ? Evidence::kFree : Evidence::kNone;
}

Evidence evidence_of(const Panorama& other, const SeenPoint& seen) {
  const Eigen::Vector3d offset = seen.position - other.origin();
  const double distance_m = offset.norm();
  if (distance_m < 0.1 || (distance_m > kMaxReturnRange_m && 0.9 * distance_m > other.max_range_m()))
    return Evidence::kNone;
  const std::optional<Pixel> center = other.pixel_of(seen.position);
  if (!center || center->row < 1 || center->row + 1 >= other.rows()) return Evidence::kNone;
  const double footprint_m = other.step_rad() * distance_m;
  const double tolerance_m = 0.03 + 0.002 * distance_m;
  const Evidence of_plane = evidence_of_plane(other, *center, seen, distance_m, tolerance_m);
  if (of_plane == Evidence::kCovered) return Evidence::kCovered;
  const Neighborhood around = neighborhood_of(other, *center, seen, distance_m, tolerance_m);
  if (is_covered_by_point(other, around, seen, footprint_m)) return Evidence::kCovered;
  if (around.is_observed || of_plane == Evidence::kObserved) return Evidence::kObserved;
  const double cosine = std::abs(seen.normal.dot(offset)) / distance_m;
  return evidence_of_free_space(around, seen, distance_m, cosine, footprint_m);
}

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
