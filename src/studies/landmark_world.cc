#include "studies/landmark_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/geometry/angles.h"
#include "core/random.h"

namespace patrol::studies {
namespace {

/// Radius of the second trajectory of [Wu25].
double radius_m(double angle_rad, bool is_circle) {
  if (is_circle) return 7.0;
  return 7.0 * (0.886 + 0.257 * std::cos(3.0 * angle_rad) + 0.086 * std::sin(2.0 * angle_rad));
}

Eigen::Vector2d point_at(double angle_rad, double offset_m, bool is_circle) {
  return (radius_m(angle_rad, is_circle) + offset_m) * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
}

/// Poses at constant speed along the closed trajectory, one per step.
std::vector<Pose2> lap(double step_m, bool is_circle) {
  constexpr double kFine_rad = 1e-5;
  std::vector<Eigen::Vector2d> points = {point_at(0.0, 0.0, is_circle)};
  double distance_m = 0.0;
  Eigen::Vector2d last = points.front();
  for (double angle = kFine_rad; angle < 2.0 * std::numbers::pi; angle += kFine_rad) {
    const Eigen::Vector2d point = point_at(angle, 0.0, is_circle);
    distance_m += (point - last).norm();
    last = point;
    if (distance_m < step_m * static_cast<double>(points.size())) continue;
    points.push_back(point);
  }
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d forward = points[i + 1] - points[i];
    poses.push_back({points[i].x(), points[i].y(), std::atan2(forward.y(), forward.x())});
  }
  return poses;
}

/// Trajectory of [Cui21] in 100 m x 80 m, clockwise from the middle, m. Its size makes FastSLAM's errors in the biased
/// world equal to the published ones (seeds 1 to 60).
const std::array<Eigen::Vector2d, 15> kCampusWaypoints_m = {{{0, 0},
                                                             {-38, 9},
                                                             {-32, 23},
                                                             {-18, 32},
                                                             {2, 33},
                                                             {18, 26},
                                                             {31, 18},
                                                             {44, 8},
                                                             {46, -8},
                                                             {35, -19},
                                                             {18, -26},
                                                             {2, -30},
                                                             {-17, -31},
                                                             {-35, -24},
                                                             {-41, -10}}};

/// Pose at the first waypoint, toward the second.
Pose2 campus_start() {
  const Eigen::Vector2d forward = kCampusWaypoints_m[1] - kCampusWaypoints_m[0];
  return {kCampusWaypoints_m[0].x(), kCampusWaypoints_m[0].y(), std::atan2(forward.y(), forward.x())};
}

/// For each segment between waypoints, one landmark 7 m to the left of its middle and one 9 m to the right of its first
/// quarter; and one more.
std::vector<Eigen::Vector2d> campus_landmarks() {
  std::vector<Eigen::Vector2d> landmarks_m = {{5.0, 8.0}};
  for (std::size_t i = 0; i < kCampusWaypoints_m.size(); ++i) {
    const Eigen::Vector2d& from = kCampusWaypoints_m[i];
    const Eigen::Vector2d along = kCampusWaypoints_m[(i + 1) % kCampusWaypoints_m.size()] - from;
    const Eigen::Vector2d left = Eigen::Vector2d(-along.y(), along.x()).normalized();
    landmarks_m.emplace_back(from + 0.5 * along + 7.0 * left);
    landmarks_m.emplace_back(from + 0.25 * along - 9.0 * left);
  }
  return landmarks_m;
}

/// Controls of a car that steers toward one waypoint after the other, in laps, with limits of 30 degrees and 20 deg/s.
/// A waypoint is passed within 1 m, or where the car cannot turn sharply enough to reach it. The start is the origin;
/// [step].
std::vector<Control> drive_laps(const std::vector<Eigen::Vector2d>& waypoints_m, double speed_mps,
                                const ControlMotion& motion, int num_steps) {
  constexpr double kMaxSteering_rad = 30.0 * kDegree, kMaxRate_radps = 20.0 * kDegree;
  std::vector<Control> controls;
  Pose2 T_map_body;
  double steering_rad = 0.0;
  std::size_t next = 1;
  for (int k = 0; k < num_steps; ++k) {
    const Eigen::Vector2d to_next = waypoints_m[next] - T_map_body.position();
    const double within_m = 0.5 * speed_mps;
    if (to_next.norm() < std::max(1.0, within_m)) next = (next + 1) % waypoints_m.size();
    const Eigen::Vector2d aim = waypoints_m[next] - T_map_body.position();
    const double wanted_rad =
        std::clamp(wrap_angle(std::atan2(aim.y(), aim.x()) - T_map_body.yaw), -kMaxSteering_rad, kMaxSteering_rad);
    const double max_change_rad = kMaxRate_radps * motion.step_s;
    steering_rad += std::clamp(wanted_rad - steering_rad, -max_change_rad, max_change_rad);
    controls.emplace_back(speed_mps, steering_rad);
    T_map_body = motion.move(T_map_body, controls.back());
  }
  return controls;
}

}  // namespace

LandmarkWorld garden_world(const std::string& odometry, bool is_circle) {
  LandmarkWorld world;
  world.name = odometry;
  const double yaw_rate_std_deg = odometry == "M" ? 10.0 : odometry == "S5" ? 5.0 : 3.0;
  world.motion = {
      .steering = Steering::kYawRate, .step_s = 0.1, .std = {odometry == "M" ? 0.2 : 0.1, yaw_rate_std_deg * kDegree}};
  if (odometry != "M") world.odometry_bias.y() = 2.0 * kDegree;
  world.noise = {.range_std_m = 0.5, .bearing_std_rad = 5.0 * kDegree};

  const std::vector<Pose2> poses = lap(0.05, is_circle);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    world.controls.emplace_back(0.5, wrap_angle(poses[i + 1].yaw - poses[i].yaw) / world.motion.step_s);
  }
  // The first pose has the heading of the first chord; the arc of the first control begins half its rotation earlier.
  const Pose2 T_map_garden =
      Pose2{poses[0].x, poses[0].y, poses[0].yaw - 0.5 * world.controls.front().y() * world.motion.step_s}.inverse();
  for (int i = 0; i < 24; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / 24.0;
    world.landmarks_m.push_back(T_map_garden * point_at(angle, i % 2 == 0 ? 2.0 : -2.0, is_circle));
  }
  return world;
}

LandmarkWorld campus_world(bool is_biased, double speed_mps, int num_steps) {
  constexpr double kFine_s = 0.025, kWheelbase_m = 2.0;
  LandmarkWorld world;
  world.name = is_biased ? "biased odometry" : "matched odometry";
  constexpr int kParts = 8;
  const Eigen::Vector2d fine_std(0.5, 5.0 * kDegree);  // standard deviation of the mean over the parts of a step
  world.motion = {.steering = Steering::kAckermann,
                  .wheelbase_m = kWheelbase_m,
                  .step_s = kFine_s * kParts,
                  .substeps = kParts,
                  .std = fine_std / std::sqrt(static_cast<double>(kParts))};
  if (is_biased) world.odometry_bias = {0.3, 2.0 * kDegree};
  world.noise = {.range_std_m = 0.3, .bearing_std_rad = 1.0 * kDegree};
  world.max_range_m = 30.0;
  world.field_of_view_rad = std::numbers::pi;
  const Pose2 T_start_site = campus_start().inverse();
  std::vector<Eigen::Vector2d> waypoints_m;
  for (const Eigen::Vector2d& p_site : kCampusWaypoints_m) waypoints_m.push_back(T_start_site * p_site);
  for (const Eigen::Vector2d& p_site : campus_landmarks()) world.landmarks_m.push_back(T_start_site * p_site);
  const ControlMotion fine = {.steering = Steering::kAckermann, .wheelbase_m = kWheelbase_m, .step_s = kFine_s};
  world.controls = drive_laps(waypoints_m, speed_mps, fine, num_steps);
  return world;
}

LandmarkRun simulate(const LandmarkWorld& world, std::uint64_t seed) {
  const RandomStream odometry(seed, "study/odometry"), observation_noise(seed, "study/sights");
  const auto substeps = static_cast<std::size_t>(world.motion.substeps);
  ControlMotion part = world.motion;
  part.step_s /= world.motion.substeps;
  part.substeps = 1;
  LandmarkRun run;
  Pose2 T_map_body;
  for (std::size_t k = 0; k < world.controls.size() / substeps; ++k) {
    Control mean = Control::Zero();
    for (std::size_t i = k * substeps; i < (k + 1) * substeps; ++i) {
      T_map_body = part.move(T_map_body, world.controls[i]);
      mean += world.controls[i] / static_cast<double>(substeps);
    }
    run.truth.push_back(T_map_body);
    const auto unit = odometry.normals(k);
    run.odometry.emplace_back(mean + world.odometry_bias +
                              world.motion.std.cwiseProduct(Eigen::Vector2d(unit[0], unit[1])));
    std::vector<RangeBearing>& observations = run.observations.emplace_back();
    for (std::size_t i = 0; i < world.landmarks_m.size(); ++i) {
      const PredictedObservation observation = predict_observation(T_map_body, world.landmarks_m[i]);
      if (observation.observation.x() > world.max_range_m ||
          std::abs(observation.observation.y()) > 0.5 * world.field_of_view_rad)
        continue;
      const auto noise = observation_noise.normals(k, i);
      observations.push_back(
          {.landmark = static_cast<int>(i),
           .range_m = observation.observation.x() + world.noise.range_std_m * noise[0],
           .bearing_rad = wrap_angle(observation.observation.y() + world.noise.bearing_std_rad * noise[1])});
    }
  }
  return run;
}

}  // namespace patrol::studies
