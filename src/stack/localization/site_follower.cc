#include "stack/localization/site_follower.h"

#include <algorithm>

#include "inspect/route_frame.h"

namespace patrol::stack {

Eigen::AlignedBox2d SiteFollower::extent_of(const Route& route) {
  Eigen::AlignedBox2d extent;
  extent.extend(Eigen::Vector2d(0.0, 0.0));
  for (const Station& station : route.stations) {
    extent.extend(station.T_route_body.position());
    extent.extend(Eigen::Vector2d(station.p_route_target.head<2>()));
  }
  for (const auto& line : route.keep_out_lines) {
    for (const Eigen::Vector2d& point : line) extent.extend(point);
  }
  for (const UwbAnchor& anchor : route.anchors) extent.extend(Eigen::Vector2d(anchor.p_m.head<2>()));
  if (route.dock) extent.extend(route.dock->T_route_docked.position());
  return extent;
}

std::optional<Route> SiteFollower::update(const SiteRegistration& registration) {
  const Pose2 T_start_map = T_start_site_ * registration.T_site_map;
  const Pose2 T_map_before = T_start_map.inverse() * T_start_map_;
  double shift_m = 0.0;
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                            Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight}) {
    const Eigen::Vector2d p_map = T_start_map_.inverse() * Eigen::Vector2d(extent_.corner(corner));
    shift_m = std::max(shift_m, (T_map_before * p_map - p_map).norm());
  }
  if (shift_m < min_shift_m_) return std::nullopt;
  T_start_map_ = T_start_map;
  return inspect::to_map(site_in_start_, T_start_map);
}

}  // namespace patrol::stack
