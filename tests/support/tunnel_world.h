#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/grid.h"
#include "core/messages.h"
#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/uwb.h"
#include "slam/grid_map.h"
#include "slam/map_rendering.h"
#include "slam/scan_integration.h"
#include "tests/support/room_world.h"

namespace patrol::test {

/// A tunnel as the lidar sees it, along x, in map: portal with some containers, a straight lined stretch without any
/// feature, bare rock with a trolley, and the face.
struct Tunnel {
  double half_width_m = 5.5;
  double lined_from_m = 12.0, lined_to_m = 112.0, face_m = 140.0;
  RoomWorld world;

  Tunnel() {
    const RandomStream rock(7, "test/rock");
    world.add_wall(-8.0, -half_width_m, -8.0, half_width_m);
    for (const double side : {-1.0, 1.0}) {
      const double y = side * half_width_m;
      world.add_wall(-8.0, y, lined_to_m, y);
      std::vector<Eigen::Vector2d> wall{{lined_to_m, y}};
      for (double x = lined_to_m + 1.0; x < face_m; x += 1.0) {
        wall.emplace_back(x, y + side * 0.6 * rock.uniform(static_cast<std::uint64_t>(x), side > 0.0 ? 1 : 0));
      }
      wall.emplace_back(face_m, y);
      world.add_polyline(wall);
    }
    world.add_wall(face_m, -half_width_m, face_m + 0.4, 0.5).add_wall(face_m + 0.4, 0.5, face_m, half_width_m);
    world.add_box(-4.0, 3.0, 2.0, 5.4).add_box(5.0, -5.4, 8.0, -3.2).add_post(10.0, 3.5, 0.3);
    world.add_box(118.0, 2.5, 123.0, 4.5).add_post(128.0, -3.0, 0.4);
  }

  /// Anchors on alternating walls, every `spacing_m`, 2.5 m above the lidar.
  std::vector<UwbAnchor> anchors(double spacing_m = 15.0) const {
    std::vector<UwbAnchor> anchors;
    for (double x = 0.0; x <= face_m; x += spacing_m) {
      const int number = static_cast<int>(anchors.size());
      anchors.push_back({number, {x, number % 2 == 0 ? half_width_m : -half_width_m, 2.5}});
    }
    return anchors;
  }
};

inline constexpr RoomWorld::ScanOptions kTunnelLidar{
    .beams = 720, .range_max_m = 25.0, .no_return_clearing_range_m = 10.0, .range_std_m = 0.02};

/// The map that a robot makes which always knows where it is: scans with noise every half metre from x_begin to x_end,
/// 5 cm cells.
inline OccupancyGrid survey(const RoomWorld& world, double x_begin_m, double x_end_m) {
  slam::GridMap map(0.05, 400.0);
  const RandomStream noise(11, "test/survey");
  std::uint64_t tick = 0;
  for (double x = x_begin_m; x <= x_end_m; x += 0.5) {
    const Pose2 T_map_body{x, 0.3 * std::sin(0.2 * x), 0.0};
    slam::integrate_scan(world.scan(T_map_body, Time{}, kTunnelLidar, noise, tick++), T_map_body, {}, map);
  }
  return slam::render_map(map, 2, 0.5);
}

/// The tunnel's map, made once for all tests of the process.
inline const OccupancyGrid& tunnel_map() {
  static const OccupancyGrid map = survey(Tunnel().world, 0.0, 136.0);
  return map;
}

struct DriveSettings {
  double speed_mps = 1.0;
  double way_scale_error = 0.0;    ///< relative error of the distance by odometry; positive: too long
  double step_std_m_per_m = 0.01;  ///< standard deviation of odometry, independent in every step
  double yaw_std_rad_per_m = 0.002;
  double range_std_m = 0.08;  ///< standard deviation of UWB ranges
  double range_reach_m = 35.0;
};

/// A robot on its way through the tunnel, with what its sensors say ten times a second.
class TunnelDrive {
 public:
  TunnelDrive(const RoomWorld& world, std::vector<UwbAnchor> anchors, const Pose3& T_body_uwb, const Pose2& T_map_start,
              const DriveSettings& settings, std::uint64_t seed)
      : world_(world),
        anchors_(std::move(anchors)),
        T_body_uwb_(T_body_uwb),
        settings_(settings),
        T_map_body_(T_map_start),
        odometry_noise_(seed, "test/odometry"),
        lidar_noise_(seed, "test/lidar"),
        uwb_noise_(seed, "test/uwb") {}

  static constexpr double kPeriod_s = 0.1;

  /// Drives on for a tenth of a second; weaves so gently that it stays in the middle.
  void step() {
    ++tick_;
    stamp_ += std::chrono::milliseconds(100);
    const double way = settings_.speed_mps * kPeriod_s;
    const double turn = direction_ * 0.02 * std::cos(0.3 * driven_m_) * way -
                        0.3 * way * wrap_angle(T_map_body_.yaw - heading_) - 0.02 * way * T_map_body_.y * direction_;
    const Pose2 T_before_now{way, 0.0, turn};
    driven_m_ += way;
    T_map_body_ = T_map_body_ * T_before_now;
    const double along =
        (1.0 + settings_.way_scale_error) * way + settings_.step_std_m_per_m * way * odometry_noise_.normal(tick_, 0);
    T_odom_body_ =
        T_odom_body_ * Pose2{along, 0.0, turn + settings_.yaw_std_rad_per_m * way * odometry_noise_.normal(tick_, 1)};
  }
  void turn_back() { heading_ = wrap_angle(heading_ + M_PI), direction_ = -direction_; }
  /// Somebody carries the robot away, and odometry does not notice.
  void kidnap_to(const Pose2& T_map_body) { T_map_body_ = T_map_body; }
  void stand() { ++tick_, stamp_ += std::chrono::milliseconds(100); }
  void set_speed(double speed_mps) { settings_.speed_mps = speed_mps; }

  Time stamp() const { return stamp_; }
  const Pose2& T_map_body() const { return T_map_body_; }
  const Pose2& T_odom_body() const { return T_odom_body_; }

  LevelScan scan() const { return scan_of(world_); }
  LevelScan scan_of(const RoomWorld& world) const {
    return world.scan(T_map_body_, stamp_, kTunnelLidar, lidar_noise_, tick_);
  }
  std::vector<UwbRange> ranges() const {
    std::vector<UwbRange> heard;
    const Eigen::Vector3d antenna = to_pose3(T_map_body_) * T_body_uwb_.position;
    for (const UwbAnchor& anchor : anchors_) {
      const double way = (anchor.p_m - antenna).norm();
      if (way > settings_.range_reach_m) continue;
      heard.push_back(
          {stamp_, anchor.number,
           way + uwb_bias_at({}, way).bias_m +
               settings_.range_std_m * uwb_noise_.normal(tick_, static_cast<std::uint64_t>(anchor.number))});
    }
    return heard;
  }

 private:
  const RoomWorld& world_;
  std::vector<UwbAnchor> anchors_;
  Pose3 T_body_uwb_;
  DriveSettings settings_;
  Time stamp_{};
  std::uint64_t tick_ = 0;
  double driven_m_ = 0.0, heading_ = 0.0, direction_ = 1.0;
  Pose2 T_map_body_, T_odom_body_;
  RandomStream odometry_noise_, lidar_noise_, uwb_noise_;
};

}  // namespace patrol::test
