#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/random.h"
#include "tests/slam/graph/office_world.h"

namespace patrol::test {

/// World and drive in which identical doors mislead a matcher that takes the best match without looking for a second
/// one. A furnished hall (x = 0 to 10 m) opens into a corridor 2 m wide: bare walls to x = 40 m, then niches every 1.5
/// m on both sides, all alike, to its end at x = 110 m.
///
/// With a lidar of 6 m, neither the hall nor the corridor's end is in range among the niches at 46 to 64 m, where the
/// drive turns. Between 16 and 34 m the scan does not constrain the position along the corridor, so an error of the
/// odometry there moves the niches of one passage against those of another by a part of their spacing.
struct DoorGallery {
  static constexpr double kSpacing_m = 1.5;
  static constexpr RoomWorld::ScanOptions kLidar{
      .beams = 360, .range_max_m = 6.0, .no_return_clearing_range_m = 5.0, .range_std_m = 0.01};

  static RoomWorld world() {
    RoomWorld gallery;
    gallery.add_polyline({{10.0, -1.0}, {10.0, -4.0}, {0.0, -4.0}, {0.0, 3.0}, {6.5, 3.0}, {6.5, 4.5}, {10.0, 4.5}});
    gallery.add_wall(10.0, 4.5, 10.0, 1.0);
    gallery.add_box(1.0, 1.4, 2.2, 2.1).add_box(7.2, -3.6, 7.9, -2.0).add_box(0.0, -4.0, 0.6, -1.7);
    gallery.add_post(3.6, -2.3, 0.25).add_post(8.4, 2.6, 0.2);
    for (const double side : {-1.0, 1.0}) {
      std::vector<Eigen::Vector2d> wall = {{10.0, side}};
      for (double x = 40.0; x < 109.0; x += kSpacing_m) {
        for (const auto& [dx, depth] : {std::pair{0.0, 0.0}, {0.0, 0.3}, {0.7, 0.3}, {0.7, 0.0}})
          wall.emplace_back(x + dx, side * (1.0 + depth));
      }
      wall.emplace_back(110.0, side);
      gallery.add_polyline(wall);
    }
    gallery.add_wall(110.0, -1.0, 110.0, 1.0);
    return gallery;
  }

  /// Drive from the hall to the niches, back, and to the niches again. The odometry's scale is drawn for each of the
  /// three legs, around 1 + `scale_mean` with a standard deviation of `scale_std`. With the default, two passages
  /// differ by one standard deviation of the drift that GraphSlam predicts for them (0.02 m per meter and submap).
  static std::vector<DriveStep> drive(std::uint64_t seed, double scale_mean = 0.0, double scale_std = 0.015) {
    std::vector<DriveStep> steps =
        drive_along({{5.0, 0.0}, {64.0, 0.0}, {5.0, 0.0}, {64.0, 0.0}},
                    {.speed_mps = 1.0, .odometry_scale = 0.0, .odometry_drift_rad_per_m = 0.002});
    const RandomStream draw(seed, "test/door_gallery");
    std::uint64_t leg = 0;
    bool was_turning = false;
    Pose2 T_odom_before = steps.front().T_odom_body;
    for (std::size_t k = 1; k < steps.size(); ++k) {
      Pose2 motion = T_odom_before.inverse() * steps[k].T_odom_body;
      T_odom_before = steps[k].T_odom_body;
      const bool is_turning = motion.position().norm() < 1e-9;
      if (was_turning && !is_turning) ++leg;
      was_turning = is_turning;
      motion.x *= 1.0 + scale_mean + scale_std * draw.normal(leg);
      steps[k].T_odom_body = steps[k - 1].T_odom_body * motion;
    }
    return steps;
  }

  /// Index of the step at which the drive is back in the hall.
  static std::size_t back_in_hall(const std::vector<DriveStep>& drive) {
    std::size_t back = drive.size() / 2;
    for (std::size_t k = drive.size() / 4; k < drive.size(); ++k) {
      if (drive[k].T_world_body.x < drive[back].T_world_body.x) back = k;
    }
    return back;
  }
};

}  // namespace patrol::test
