#include "importer/site/points/point_evidence.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace patrol::importer {
namespace {

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

}  // namespace

double spacing_on_surface_m(double range_m, double step_rad, double cosine) {
  return range_m * step_rad / std::sqrt(std::max(cosine, 0.05));
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

}  // namespace patrol::importer
