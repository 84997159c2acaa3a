#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "core/frames.h"

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
};

/// The order of stations, and lines that the robot must not walk across (full-height kerbs, which its 2D lidar cannot
/// see but the survey knows).
struct Route {
  std::vector<Station> stations;
  std::vector<std::vector<Eigen::Vector2d>> keep_out_lines;  ///< polylines in the route's frame, m
};

}  // namespace patrol
