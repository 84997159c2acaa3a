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

/// A place of the inspection route, in the route's frame: `site`, the frame of the survey, or `map`. The robot's start pose in
/// `site` is surveyed too, and joins the two (inspect/route_frame.h).
struct Station {
  int number = 0;
  std::string name;  ///< e.g. "regulator_box_2"
  std::string type;  ///< "inspect": stop, aim, measure gas; "pass": walk by; "home": stop and end
  Pose2 T_route_body;  ///< where the robot shall stand
  Eigen::Vector3d p_route_target = Eigen::Vector3d::Zero();  ///< what the instrument looks at, m
  double accuracy_m = 0.2;  ///< how near the standing place counts as reached
  int priority = 0;         ///< lower ones come first, where the robot orders its stations itself
  double earliest_s = 0.0;  ///< of the mission: work there does not begin before, and
  double latest_s = std::numeric_limits<double>::infinity();  ///< if it can be helped, not after
};

/// The post at which the robot charges: where its body is when it is docked, and the post's outline at the lidar's height.
struct Dock {
  Pose2 T_route_docked;
  std::vector<Eigen::Vector2d> profile_m;  ///< polyline in the docked body's frame
};

/// The order of stations, and lines that the robot must not walk across (full-height kerbs, which its 2D lidar cannot
/// see but the survey knows).
struct Route {
  std::vector<Station> stations = {};
  std::vector<std::vector<Eigen::Vector2d>> keep_out_lines = {};  ///< polylines in the route's frame, m
  std::vector<UwbAnchor> anchors = {};                            ///< in the route's frame
  std::optional<Dock> dock = {};
  std::optional<TunnelLining> lining = {};
};

/// A place to drive to, marked in `map` by driving there: an entry of nav.json (paper 004, table 1).
struct MarkedGoal {
  int number = 0;
  Pose2 T_map_body;
  char type = 'N';          ///< 'N' stop there, 'V' pass by, 'D' scan the lining, 'R' stop until a person has driven and handed over again
  double accuracy_m = 0.1;  ///< how near counts as reached
};

}  // namespace patrol
