#include "app/study/landmark_world.h"

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace patrol::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// The way of paper 000's second world.
double radius_m(double angle_rad, bool is_circle) {
  if (is_circle) return 7.0;
  return 7.0 * (0.886 + 0.257 * std::cos(3.0 * angle_rad) + 0.086 * std::sin(2.0 * angle_rad));
}

Eigen::Vector2d point_at(double angle_rad, double offset_m, bool is_circle) {
  return (radius_m(angle_rad, is_circle) + offset_m) * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

/// Poses at a constant speed along the way, one a step, until it is closed.
std::vector<Pose2> lap(double step_m, bool is_circle) {
  constexpr double kFine_rad = 1e-5;
  std::vector<Eigen::Vector2d> points = {point_at(0.0, 0.0, is_circle)};
  double way_m = 0.0;
  Eigen::Vector2d last = points.front();
  for (double angle = kFine_rad; angle < 2.0 * std::numbers::pi; angle += kFine_rad) {
    const Eigen::Vector2d point = point_at(angle, 0.0, is_circle);
    way_m += (point - last).norm();
    last = point;
    if (way_m < step_m * static_cast<double>(points.size())) continue;
    points.push_back(point);
  }
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d forward = points[i + 1] - points[i];
    poses.push_back({points[i].x(), points[i].y(), std::atan2(forward.y(), forward.x())});
  }
  return poses;
}

}  // namespace

LandmarkWorld garden_world(const std::string& odometry, bool is_circle) {
  LandmarkWorld world;
  world.name = odometry;
  const double yaw_rate_std_deg = odometry == "M" ? 10.0 : odometry == "S5" ? 5.0 : 3.0;
  world.motion = {.steering = slam::Steering::kYawRate, .step_s = 0.1, .std = {odometry == "M" ? 0.2 : 0.1, yaw_rate_std_deg * kDegree}};
  if (odometry != "M") world.odometry_bias.y() = 2.0 * kDegree;
  world.noise = {.range_std_m = 0.5, .bearing_std_rad = 5.0 * kDegree};

  const std::vector<Pose2> poses = lap(0.05, is_circle);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    world.controls.emplace_back(0.5, wrap_angle(poses[i + 1].yaw - poses[i].yaw) / world.motion.step_s);
  }
  // The controls bend where the poses turn: half a turn of a step ahead of the first chord.
  const Pose2 T_map_garden = Pose2{poses[0].x, poses[0].y, poses[0].yaw - 0.5 * world.controls.front().y() * world.motion.step_s}.inverse();
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / 24.0;
    world.landmarks_m.push_back(T_map_garden * point_at(angle, i % 2 == 0 ? 2.0 : -2.0, is_circle));
  }
  return world;
}

LandmarkRun simulate(const LandmarkWorld& world, std::uint64_t seed) {
  const RandomStream odometry(seed, "study/odometry"), sights(seed, "study/sights");
  LandmarkRun run;
  Pose2 T_map_body;
  for (std::size_t k = 0; k < world.controls.size(); ++k) {
    T_map_body = world.motion.move(T_map_body, world.controls[k]);
    run.truth.push_back(T_map_body);
    const auto unit = odometry.normals(k);
    run.odometry.push_back(world.controls[k] + world.odometry_bias + world.motion.std.cwiseProduct(Eigen::Vector2d(unit[0], unit[1])));
    std::vector<slam::RangeBearing>& seen = run.seen.emplace_back();
    if ((k + 1) % static_cast<std::size_t>(world.steps_per_sight) != 0) continue;
    for (std::size_t i = 0; i < world.landmarks_m.size(); ++i) {
      const slam::PredictedSight sight = slam::predict_sight(T_map_body, world.landmarks_m[i]);
      if (sight.sight.x() > world.max_range_m || std::abs(sight.sight.y()) > 0.5 * world.field_of_view_rad) continue;
      const auto noise = sights.normals(k, i);
      seen.push_back({.landmark = static_cast<int>(i),
                      .range_m = sight.sight.x() + world.noise.range_std_m * noise[0],
                      .bearing_rad = wrap_angle(sight.sight.y() + world.noise.bearing_std_rad * noise[1])});
    }
  }
  return run;
}

}  // namespace patrol::app
