#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"
#include "core/settings.h"

namespace patrol::plan {

struct DepthPointsSettings {
  double max_range_m = 1.6;       ///< beyond, a row of pixels covers too much ground to judge by
  double clear_range_m = 1.3;     ///< as far ground that is seen says that nothing stands there
  double min_rise_m = 0.04;       ///< a step up that is no rubble
  double max_slope = 0.32;        ///< rise over run of what can be driven on: 17.7 degrees
  double max_height_m = 0.8;      ///< above the plane under the robot: higher things are left to the lidar
  int rows_below = 8;             ///< of the image, in which the ground before a thing is looked for

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_range_m", self.max_range_m, between(0.3, 10.0));
    visit("clear_range_m", self.clear_range_m, between(0.0, 10.0));
    visit("min_rise_m", self.min_rise_m, between(0.01, 0.5));
    visit("max_slope", self.max_slope, between(0.0, 2.0));
    visit("max_height_m", self.max_height_m, between(0.05, 5.0));
    visit("rows_below", self.rows_below, between(1, 100));
  }
};

/// What a depth image says of the ground, in level.
struct DepthPoints {
  std::vector<Eigen::Vector2d> obstacles_m;  ///< stand on the ground
  std::vector<Eigen::Vector2d> ground_m;     ///< near enough that something there would have been seen
};

/// Tells obstacles from ground by their slope (Vosselman, "Slope based filtering of laser altimetry data", 2000): a point
/// belongs to an obstacle if it rises above some ground nearby by more than
///
///   min_rise + max_slope * (distance between the two in the plane).
///
/// The ground compared with is what the image shows in the rows below, nearer to the robot. A rule of neighbours needs no
/// plane: a ramp and its foot stay below the slope, rubble below the rise, on whatever ground the robot stands; only the top of
/// something long is not told from ground, its front edge always is. Depths are median filtered along their row (three columns), the
/// ground once more (over five), which takes off two thirds of the noise and everything narrower than two pixels.
///
/// `T_level_camera`: x is the optical axis; tilt included. `body_height_m`: of level's origin above the ground.
DepthPoints find_depth_points(const DepthPointsSettings& settings, const DepthImage& image, const Pose3& T_level_camera,
                              double body_height_m);

}  // namespace patrol::plan
