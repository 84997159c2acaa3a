#include "importer/site/points/beam_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace patrol::importer {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Circle around a prism, seen from above.
struct Surroundings {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
};

Surroundings surroundings_of(const ConvexPolygon& outline_m) {
  constexpr double kMargin_m = 0.05;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : outline_m) box.extend(corner);
  Surroundings around{.center_m = box.center(), .radius_m = 0.0};
  for (const Eigen::Vector2d& corner : outline_m)
    around.radius_m = std::max(around.radius_m, (corner - around.center_m).norm());
  around.radius_m += kMargin_m;
  return around;
}

/// Returns whether a point is within 3 cm of the sides of a convex outline, or inside of it.
bool is_near(const ConvexPolygon& outline_m, const Eigen::Vector2d& p_m) {
  constexpr double kNear_m = 0.03;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d along = (outline_m[(i + 1) % outline_m.size()] - outline_m[i]).normalized(),
                          offset = p_m - outline_m[i];
    if (along.y() * offset.x() - along.x() * offset.y() > kNear_m) return false;
  }
  return true;
}

void add_beams(const Prism& prism, const Surroundings& around, const std::vector<Panorama>& scans, std::size_t index,
               int max_beams, std::vector<PlanBeam>& beams) {
  constexpr double kNearest_m = 0.5;
  const Panorama& scan = scans[index];
  const Eigen::Vector2d origin_m = scan.origin().head<2>(), offset_m = around.center_m - origin_m;
  const double distance_m = offset_m.norm();
  if (distance_m < around.radius_m + kNearest_m) return;
  const int low_row = std::max(0, scan.nearest_pixel({around.center_m.x(), around.center_m.y(), prism.low_m}).row);
  const Pixel top = scan.nearest_pixel({around.center_m.x(), around.center_m.y(), prism.high_m});
  const int high_row = std::min(scan.rows() - 1, top.row);
  if (high_row < low_row) return;
  const int reach = static_cast<int>(std::ceil(std::asin(around.radius_m / distance_m) / scan.step_rad())) + 1;
  const int max_rows = std::max(1, max_beams / (2 * reach + 1)), row_step = (high_row - low_row) / max_rows + 1;
  for (int k = -reach; k <= reach; ++k) {
    for (int row = low_row + row_step / 2; row <= high_row; row += row_step) {
      const Pixel pixel{scan.wrapped(top.col + k), row};
      if (scan.has(pixel, kPixelBlocked)) continue;
      const Eigen::Vector3d d = scan.direction(pixel);
      const double level = d.head<2>().norm();
      PlanBeam beam{.origin_m = origin_m,
                    .direction = d.head<2>() / level,
                    .range_m = kInfinite,
                    .is_hit = false,
                    .height_m = 0.0,
                    .scan = index,
                    .pixel = pixel};
      const double along_m = beam.direction.dot(offset_m);
      if ((offset_m - along_m * beam.direction).norm() > around.radius_m) continue;
      const double height_m = scan.origin().z() + along_m / level * d.z();
      if (height_m < prism.low_m || height_m > prism.high_m) continue;
      beam.height_m = height_m - 0.5 * (prism.low_m + prism.high_m);
      if (scan.range_m(pixel) > 0.0f) beam.range_m = level * double{scan.range_m(pixel)};
      if (beam.range_m < along_m - around.radius_m) continue;
      beam.is_hit =
          std::isfinite(beam.range_m) && is_near(prism.outline_m, beam.origin_m + beam.range_m * beam.direction);
      if (!beam.is_hit && beam.range_m < along_m) continue;
      beams.push_back(beam);
    }
  }
}

}  // namespace

std::vector<PlanBeam> beams_across(const Prism& prism, const std::vector<Panorama>& scans, int max_beams) {
  const Surroundings around = surroundings_of(prism.outline_m);
  std::vector<PlanBeam> beams;
  for (std::size_t i = 0; i < scans.size(); ++i) add_beams(prism, around, scans, i, max_beams, beams);
  return beams;
}

PlanCrossing crossing_of(const PlanBeam& beam, const ConvexPolygon& outline_m, const Eigen::Vector2d& slope) {
  const Eigen::Vector2d origin_m = beam.origin_m - beam.height_m * slope;
  double lowest = kInfinite, highest = -kInfinite, enter = -kInfinite, leave = kInfinite;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const Eigen::Vector2d offset = outline_m[i] - origin_m,
                          along = outline_m[i + 1 < outline_m.size() ? i + 1 : 0] - outline_m[i];
    const double aside = beam.direction.x() * offset.y() - beam.direction.y() * offset.x();
    lowest = std::min(lowest, aside);
    highest = std::max(highest, aside);
    // Along the beam at t, the distance from the side, inward, is rate * t - outside.
    const double rate = along.x() * beam.direction.y() - along.y() * beam.direction.x(),
                 outside = along.x() * offset.y() - along.y() * offset.x();
    if (rate > 0.0) enter = std::max(enter, outside / rate);
    if (rate < 0.0) leave = std::min(leave, outside / rate);
  }
  const double clearance_m = std::max(lowest, -highest);
  return {.clearance_m = clearance_m, .entry_m = enter, .chord_m = clearance_m < 0.0 ? leave - enter : 0.0};
}

PlanCrossing crossing_of(const PlanBeam& beam, const Eigen::Vector2d& center_m, double radius_m,
                         const Eigen::Vector2d& slope) {
  const Eigen::Vector2d offset = center_m + beam.height_m * slope - beam.origin_m;
  const double along = beam.direction.dot(offset),
               aside = std::abs(beam.direction.x() * offset.y() - beam.direction.y() * offset.x());
  const double half = std::sqrt(std::max(0.0, radius_m * radius_m - aside * aside));
  return {.clearance_m = aside - radius_m, .entry_m = along - half, .chord_m = 2.0 * half};
}

}  // namespace patrol::importer
