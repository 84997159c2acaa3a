#include "inspect/lining/lining_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"

namespace patrol::inspect {
namespace {

/// Returns the design shifted to the left, rotated about the scanner and raised.
LiningInMap shift_design(const LiningInMap& lining, const Eigen::Vector2d& about, const Eigen::Vector2d& left,
                         const Eigen::Vector3d& step) {
  LiningInMap result = lining;
  const Pose2 T_map_pivot{about.x(), about.y(), 0.0};
  const Pose2 turn = T_map_pivot * Pose2{0.0, 0.0, step[1]} * T_map_pivot.inverse();
  result.design.T_route_start = turn * lining.design.T_route_start;
  result.design.T_route_start.x += step[0] * left.x();
  result.design.T_route_start.y += step[0] * left.y();
  result.invert_m += step[2];
  return result;
}

/// Returns the height of the invert from the crown above the scanner, using the outermost points there.
std::optional<double> invert_by_crown(const TunnelLining& design, const std::vector<DownsampledPoint>& points,
                                      const Eigen::Vector3d& scanner) {
  const double here_m = design.to_tunnel_coordinates(scanner).chainage_m;
  std::vector<double> heights;
  for (const DownsampledPoint& point : points) {
    const TunnelCoordinates coordinates = design.to_tunnel_coordinates(point.p);
    if (std::abs(coordinates.chainage_m - here_m) < 3.0 && std::abs(coordinates.left_m) < 1.0 &&
        point.p.z() > scanner.z() + 1.0)
      heights.push_back(point.p.z());
  }
  if (heights.size() < 20) return std::nullopt;
  const auto high = heights.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(heights.size()));
  std::ranges::nth_element(heights, high);
  return *high - design.crown_center_m - design.crown_radius_m;
}

}  // namespace

Eigen::Vector3d LiningInMap::intrados(double chainage_m, double clock_deg) const {
  return design.intrados(chainage_m, clock_deg) + Eigen::Vector3d(0.0, 0.0, invert_m);
}

LiningPoint lining_point(const LiningInMap& lining, const Eigen::Vector3d& p_map) {
  const TunnelLining& design = lining.design;
  const TunnelCoordinates coordinates =
      design.to_tunnel_coordinates({p_map.x(), p_map.y(), p_map.z() - lining.invert_m});
  const double clock_deg = design.clock_deg(coordinates), up_m = coordinates.height_m - design.crown_center_m;
  const double radius_m = std::hypot(coordinates.left_m, up_m);
  LiningPoint point{.chainage_m = coordinates.chainage_m,
                    .clock_deg = clock_deg > 180.0 ? clock_deg - 360.0 : clock_deg};
  if (!(radius_m > 0.0)) return point;
  point.inward_m = design.radius_at(clock_deg) - radius_m;
  // Inward normal of the surface. Above the center of the half circle it is radial. Below, it points to the center of
  // the side wall arc, beyond the axis. There the radial distance is longer than the normal one by the cosine between
  // both directions.
  const double side = coordinates.left_m > 0.0 ? 1.0 : -1.0;
  const double beyond_m = up_m < 0.0 ? side * (design.side_radius_m - design.crown_radius_m) : 0.0;
  const Eigen::Vector2d radial = -Eigen::Vector2d(coordinates.left_m, up_m) / radius_m;
  const Eigen::Vector2d across = -Eigen::Vector2d(coordinates.left_m + beyond_m, up_m).normalized();
  const Eigen::Vector2d gradient = across / std::max(0.1, across.dot(radial));
  const double heading = design.heading_at(coordinates.chainage_m);
  point.gradient = {-std::sin(heading) * gradient.x(), std::cos(heading) * gradient.x(), gradient.y()};
  return point;
}

LiningGrid::LiningGrid(const LiningInMap& lining, const Eigen::Vector3d& p_map_scanner, const LiningSettings& settings)
    : half_sectors(static_cast<int>(std::floor(settings.lowest_clock_deg / settings.sector_deg + 1e-9))),
      sector_deg(settings.sector_deg),
      ring_length_m(lining.design.ring_length_m),
      first_ring_m(lining.design.first_ring_m),
      joint_margin_m(settings.joint_margin_m) {
  // Rings that are completely in range.
  const double here_m = lining.design.to_tunnel_coordinates(p_map_scanner).chainage_m - first_ring_m;
  const int low = static_cast<int>(std::ceil((here_m - settings.comparison_range_m) / ring_length_m - 1e-9)) + 1;
  const int high = static_cast<int>(std::floor((here_m + settings.comparison_range_m) / ring_length_m + 1e-9));
  first_ring = std::clamp(low, 1, lining.design.rings + 1);
  rings = std::max(0, std::min(high, lining.design.rings) - first_ring + 1);
}

double LiningGrid::clock_deg(int sector) const {
  const double clock = (sector - half_sectors) * sector_deg;
  return clock < 0.0 ? clock + 360.0 : clock;
}

int LiningGrid::cell_at(const LiningPoint& point) const {
  const double ring_coordinate = (point.chainage_m - first_ring_m) / ring_length_m;
  const double ring = std::floor(ring_coordinate) + 1.0, margin = joint_margin_m / ring_length_m;
  if (ring < first_ring || ring >= first_ring + rings || ring_coordinate - std::floor(ring_coordinate) < margin ||
      ring_coordinate - std::floor(ring_coordinate) > 1.0 - margin)
    return -1;
  const double sector = std::round(point.clock_deg / sector_deg) + half_sectors;
  if (sector < 0.0 || sector >= sectors()) return -1;
  return (static_cast<int>(ring) - first_ring) * sectors() + static_cast<int>(sector);
}

std::optional<LiningInMap> fit_design(const TunnelLining& design_in_map,
                                      const std::vector<DownsampledPoint>& points_map,
                                      const Eigen::Vector3d& p_map_scanner, const LiningSettings& settings) {
  constexpr double kFirstKernel_m = 0.4, kLastKernel_m = 0.02;
  constexpr int kMinPoints = 100;
  const auto invert_m = invert_by_crown(design_in_map, points_map, p_map_scanner);
  if (!invert_m) return std::nullopt;
  LiningInMap lining{.design = design_in_map, .invert_m = *invert_m};
  const Eigen::Vector2d about = p_map_scanner.head<2>();
  const double here_m = design_in_map.to_tunnel_coordinates(p_map_scanner).chainage_m;
  const double heading = design_in_map.heading_at(here_m);
  const Eigen::Vector2d left(-std::sin(heading), std::cos(heading));
  const double max_deg = settings.lowest_clock_deg - 0.5 * settings.sector_deg;

  double kernel_m = kFirstKernel_m;
  for (int iteration = 0; iteration < 20; ++iteration, kernel_m = std::max(kLastKernel_m, 0.7 * kernel_m)) {
    Eigen::Matrix3d H = Eigen::Vector3d(1e-6, 1e-6, 1e-6).asDiagonal();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    int near = 0;
    for (const DownsampledPoint& sample : points_map) {
      const LiningPoint point = lining_point(lining, sample.p);
      const double ratio = point.inward_m / kernel_m;
      if (std::abs(point.chainage_m - here_m) > settings.comparison_range_m || std::abs(point.clock_deg) > max_deg ||
          std::abs(ratio) >= 1.0)
        continue;
      const Eigen::Vector2d arm = sample.p.head<2>() - about;
      // Moving the design has the opposite effect of moving the point.
      const Eigen::Vector3d J(-point.gradient.head<2>().dot(left),
                              -(point.gradient.y() * arm.x() - point.gradient.x() * arm.y()), -point.gradient.z());
      const double weight = (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
      H += weight * J * J.transpose();
      b += weight * point.inward_m * J;
      near += std::abs(point.inward_m) < 0.1 ? 1 : 0;
    }
    if (near < kMinPoints) return std::nullopt;
    const Eigen::Vector3d step = -solve_symmetric(H, b);
    lining = shift_design(lining, about, left, step);
    if (kernel_m == kLastKernel_m && step.norm() < 1e-6) break;
  }
  return lining;
}

}  // namespace patrol::inspect
