#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "plan/perception/depth_obstacles_settings.h"

namespace patrol::plan {

/// Obstacles and ground in a depth image, in level.
struct DepthPoints {
  std::vector<Eigen::Vector2d> obstacles_m;  ///< points on obstacles
  std::vector<Eigen::Vector2d> ground_m;     ///< ground points within `clearing_range_m`: no obstacle there
};

/// Segments obstacles from ground by slope [Vosselman00]: a point belongs to an obstacle if it rises above some nearby
/// ground point by more than
///
///   min_rise + max_slope * (distance between the two in the plane).
///
/// The reference ground points are those of the image rows below, nearer to the robot. This neighborhood rule needs no
/// ground plane: a ramp and its foot stay below the slope, rubble below the rise, on any ground under the robot. The
/// top of a long object is classified as ground, its front edge as obstacle. Depths are median filtered along their row
/// over three columns, ground points once more over five. The filters remove two thirds of the noise and everything
/// narrower than two pixels.
///
/// `T_level_camera`: camera pose with x along the optical axis, tilt included. `body_height_m`: height of level's
/// origin above the ground.
DepthPoints segment_obstacles(const DepthObstaclesSettings& settings, const DepthImage& image,
                              const Pose3& T_level_camera, double body_height_m);

}  // namespace patrol::plan
