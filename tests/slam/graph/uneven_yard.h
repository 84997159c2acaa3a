#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "core/random.h"
#include "core/time.h"
#include "tests/slam/graph/office_world.h"
#include "tests/support/room_world.h"

namespace patrol::test {

/// A yard of 30 m x 20 m on hills with slopes of up to 9 degrees, with a fence, boxes and posts. A lidar that pitches
/// with the robot sees the ground in front of it, and looks over fence and boxes where it points up.
class UnevenYard {
 public:
  explicit UnevenYard(std::uint64_t seed) : noise_(seed, "test/uneven_yard") {
    low_.add_box(0.0, 0.0, kLength_m, kWidth_m);
    std::uint64_t draw = 0;
    const auto uniform = [&](double low, double high) { return low + (high - low) * noise_.uniform(draw++); };
    for (double& phase : phases_) phase = uniform(0.0, 6.28);
    for (int post = 0; post < 6; ++post)
      tall_.add_post(uniform(1.0, kLength_m - 1.0), uniform(1.0, kWidth_m - 1.0), 0.12);
    for (int box = 0; box < 4; ++box) {
      const double x = uniform(2.0, kLength_m - 3.0), y = uniform(2.0, kWidth_m - 3.0);
      low_.add_box(x, y, x + uniform(0.4, 1.4), y + uniform(0.4, 1.4));
    }
  }

  /// Scan leveled as by the stack: hits below or above the band of obstacles are not hits. Without beams if the tilt is
  /// above 0.1 rad.
  LevelScan scan(const Pose2& T_world_body, Time stamp, std::uint64_t tick) const {
    constexpr int kBeams = 400;
    constexpr double kRange_m = 30.0, kStd_m = 0.01, kClearing_m = 6.0, kMaxTilt_rad = 0.1;
    const Eigen::Vector2d slope = slope_at(T_world_body.position());
    LevelScan scan;
    scan.stamp = stamp;
    scan.tilt_rad = slope.norm();
    if (scan.tilt_rad > kMaxTilt_rad) return scan;
    const std::vector<double> low = low_.ranges_m(T_world_body, kBeams, kRange_m),
                              tall = tall_.ranges_m(T_world_body, kBeams, kRange_m);
    for (std::size_t beam = 0; beam < low.size(); ++beam) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(beam) / kBeams;
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const Ray ray{.start = T_world_body.position(),
                    .direction = Eigen::Rotation2Dd(T_world_body.yaw) * direction,
                    .start_m = height_m(T_world_body.position()) + kLidar_m,
                    .rise = slope.dot(Eigen::Rotation2Dd(T_world_body.yaw) * direction)};
      double range = tall[beam];
      if (low[beam] < range && above_ground_m(ray, low[beam]) < kFence_m) range = low[beam];
      range = std::min(range, to_ground_m(ray, std::min(range, kRange_m)));
      const double in_band = length_in_band(ray.rise);
      const bool has_return = range <= kRange_m, is_hit = has_return && range <= in_band;
      range = std::min(has_return ? range : kClearing_m, in_band);
      if (is_hit) range += kStd_m * noise_.normal(1000 + tick, beam);
      scan.beams.push_back({(range * direction).cast<float>(), is_hit});
    }
    return scan;
  }

 private:
  static constexpr double kLength_m = 30.0, kWidth_m = 20.0, kHills = 0.7, kLidar_m = 0.44, kFence_m = 0.8;

  struct Ray {
    Eigen::Vector2d start, direction;
    double start_m, rise;
  };

  double height_m(const Eigen::Vector2d& p) const {
    return kHills * (0.30 * std::sin(0.449 * p.x() + phases_[0]) * std::cos(0.393 * p.y() + phases_[1]) +
                     0.18 * std::sin(0.571 * p.y() + phases_[2]) + 0.12 * std::sin(0.698 * p.x() + phases_[3]));
  }

  /// Slope under a robot with a wheelbase of 0.7 m.
  Eigen::Vector2d slope_at(const Eigen::Vector2d& p) const {
    constexpr double kHalf_m = 0.35;
    const Eigen::Vector2d x(kHalf_m, 0.0), y(0.0, kHalf_m);
    return Eigen::Vector2d(height_m(p + x) - height_m(p - x), height_m(p + y) - height_m(p - y)) / (2.0 * kHalf_m);
  }

  double above_ground_m(const Ray& ray, double range_m) const {
    return ray.start_m + range_m * ray.rise - height_m(ray.start + range_m * ray.direction);
  }

  /// Infinite beyond `end_m`.
  double to_ground_m(const Ray& ray, double end_m) const {
    constexpr double kStep_m = 0.25;
    for (double range = kStep_m; range < end_m; range += kStep_m) {
      if (above_ground_m(ray, range) > 0.0) continue;
      double above = range - kStep_m, below = range;
      for (int i = 0; i < 8; ++i) {
        const double middle = 0.5 * (above + below);
        (above_ground_m(ray, middle) > 0.0 ? above : below) = middle;
      }
      return below;
    }
    return std::numeric_limits<double>::infinity();
  }

  static double length_in_band(double rise) {
    constexpr double kMin_m = 0.15, kMax_m = 1.5, kMargin_rad = 0.008;
    const double infinite = std::numeric_limits<double>::infinity();
    return std::min(rise < kMargin_rad ? (kLidar_m - kMin_m) / (kMargin_rad - rise) : infinite,
                    rise > 0.0 ? (kMax_m - kLidar_m) / rise : infinite);
  }

  RandomStream noise_;
  std::array<double, 4> phases_{};
  RoomWorld low_, tall_;
};

/// A drive of 0.8 m/s from corner to corner of random lines, with odometry of wheels and gyro: distances off by up to
/// 5 %, 0.001 rad of turn per meter, noise.
inline std::vector<DriveStep> drive_in_uneven_yard(std::uint64_t seed) {
  const RandomStream draws(seed, "test/uneven_drive");
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) { return low + (high - low) * draws.uniform(draw++); };
  std::vector<Eigen::Vector2d> corners = {{2.0, 2.0}};
  for (int i = 0; i < 8; ++i) {
    const double x = uniform(2.0, 28.0), y = uniform(2.0, 18.0);
    corners.emplace_back(x, y);
  }
  corners.emplace_back(2.0, 2.0);
  std::vector<DriveStep> drive = drive_along(corners, {.speed_mps = 0.8, .turn_radps = 0.6, .period_s = 0.1});
  const double scale = uniform(0.98, 1.05), steering = uniform(-0.001, 0.001);
  drive[0].T_odom_body = {};
  for (std::size_t k = 1; k < drive.size(); ++k) {
    Pose2 motion = drive[k - 1].T_world_body.inverse() * drive[k].T_world_body;
    const double distance_m = motion.position().norm();
    motion.x *= scale + 0.02 * draws.normal(k, 1000);
    motion.y += 0.01 * distance_m * draws.normal(k, 1001);
    motion.yaw += 0.002 * motion.yaw + steering * distance_m + 0.0004 * draws.normal(k, 1002);
    drive[k].T_odom_body = drive[k - 1].T_odom_body * motion;
  }
  return drive;
}

}  // namespace patrol::test
