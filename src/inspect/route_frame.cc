#include "inspect/route_frame.h"

namespace patrol::inspect {

Route to_map(const Route& route_in_site, const Pose2& T_site_start) {
  const Pose2 T_map_site = T_site_start.inverse();
  Route route = route_in_site;
  for (Station& station : route.stations) {
    station.T_route_body = T_map_site * station.T_route_body;
    const Eigen::Vector2d target = T_map_site * Eigen::Vector2d(station.p_route_target.head<2>());
    station.p_route_target.head<2>() = target;
  }
  for (auto& line : route.keep_out_lines) {
    for (Eigen::Vector2d& point : line) point = T_map_site * point;
  }
  for (UwbAnchor& anchor : route.anchors) {
    const Eigen::Vector2d p = T_map_site * Eigen::Vector2d(anchor.p_m.head<2>());
    anchor.p_m.head<2>() = p;
  }
  if (route.lining) route.lining->T_route_start = T_map_site * route.lining->T_route_start;
  if (route.dock) route.dock->T_route_docked = T_map_site * route.dock->T_route_docked;
  return route;
}

}  // namespace patrol::inspect
