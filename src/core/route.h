#pragma once

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/tunnel_lining.h"
#include "core/uwb.h"

namespace patrol {

/// Station of the inspection route, in the frame of the route: `site` (the survey frame) or `map`. The surveyed start
/// pose of the robot in `site` relates the two frames (inspect/route_frame.h).
struct Station {
  int number = 0;
  std::string name;  ///< e.g. "regulator_box_2"
  std::string type;  ///< "inspect": stop, aim, measure gas; "pass": walk by without stopping; "home": stop and end
  Pose2 T_route_body;  ///< pose of the robot at the station
  Eigen::Vector3d p_route_target = Eigen::Vector3d::Zero();  ///< target point of the instrument, m
  double accuracy_m = 0.2;  ///< position tolerance at the station
  int priority = 0;         ///< lower values are visited first if the robot orders the stations itself
  double earliest_s = 0.0;  ///< start of the time window since mission start: no work before it
  /// End of the time window since mission start; a soft limit.
  double latest_s = std::numeric_limits<double>::infinity();
};

/// Charging post: pose of the docked robot and outline of the post at lidar height.
struct Dock {
  Pose2 T_route_docked;
  std::vector<Eigen::Vector2d> profile_m;  ///< polyline in the frame of the docked body
};

/// Stations in their order, and keep-out lines that the robot must not cross. Keep-out lines are surveyed full-height
/// curbs, which the 2D lidar cannot detect.
struct Route {
  std::vector<Station> stations = {};
  std::vector<std::vector<Eigen::Vector2d>> keep_out_lines = {};  ///< polylines in the frame of the route, m
  std::vector<UwbAnchor> anchors = {};                            ///< positions in the frame of the route
  std::optional<Dock> dock = {};
  std::optional<TunnelLining> lining = {};
};

/// Goal pose in `map`, saved while a person drove the robot there: an entry of nav.json [Liu21, table 1].
struct MarkedGoal {
  int number = 0;
  Pose2 T_map_body;
  /// 'N' stop, 'V' pass by, 'D' scan the lining, 'R' stop until an operator has driven and handed control back.
  char type = 'N';
  double accuracy_m = 0.1;  ///< position tolerance
};

}  // namespace patrol
