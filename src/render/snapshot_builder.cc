#include "render/snapshot_builder.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "sim/mujoco.h"

namespace patrol::render {
namespace {

constexpr double kPathStep_m = 0.05;  // minimum distance between points of a drawn path
constexpr double kAboveGround_m = 0.01;
constexpr double kMinKidnapStep_m =
    0.5;  // a larger step between two true poses is a kidnapping, not a motion of the robot

void extend(std::vector<Eigen::Vector3d>& path, const Eigen::Vector3d& point) {
  if (path.empty() || (point - path.back()).head<2>().norm() >= kPathStep_m) path.push_back(point);
}

/// Pose of a sensor in the body frame from the site of its name, none without this site.
std::optional<Pose3> sensor_on_body(const mjModel& model, const char* name) {
  const int site = mj_name2id(&model, mjOBJ_SITE, name);
  if (site < 0) return std::nullopt;
  const sim::DataPtr data = sim::make_data(model);
  mj_kinematics(&model, data.get());
  const int body = mj_name2id(&model, mjOBJ_BODY, frame_id::kBody);
  const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>> R_world_sensor(data->site_xmat + 9 * site);
  const mjtNum* q = data->xquat + 4 * body;
  const Pose3 T_world_body{Eigen::Map<const Eigen::Vector3d>(data->xpos + 3 * body), {q[0], q[1], q[2], q[3]}};
  const Pose3 T_world_sensor{Eigen::Map<const Eigen::Vector3d>(data->site_xpos + 3 * site),
                             Eigen::Quaterniond(Eigen::Matrix3d(R_world_sensor))};
  return T_world_body.inverse() * T_world_sensor;
}

/// Returns whether the robot has sprockets or wheels: hinges that turn endlessly.
bool has_drive(const mjModel& model) {
  for (int joint = 0; joint < model.njnt; ++joint) {
    if (model.jnt_type[joint] == mjJNT_HINGE && !model.jnt_limited[joint]) return true;
  }
  return false;
}

}  // namespace

SnapshotBuilder::SnapshotBuilder(const mjModel& view, const Pose2& T_world_map)
    : scenery_(view), T_body_lidar_(sensor_on_body(view, "lidar").value_or(Pose3{})) {
  if (const auto T_body_camera = sensor_on_body(view, "depth_camera")) head_m_ = T_body_camera->position;
  snapshot_.T_world_map = T_world_map;
  snapshot_.is_driving = has_drive(view);
  // Move actors away: paths are projected to the ground, not onto actors.
  constexpr double kOutOfView_m = -1000.0;
  const sim::DataPtr data = sim::make_data(view);
  for (int actor = 0; actor < view.nmocap; ++actor) data->mocap_pos[3 * actor + 2] = kOutOfView_m;
  mj_kinematics(&view, data.get());
  scenery_.update(*data);
}

void SnapshotBuilder::add(const OdometryEstimate& odometry) {
  constexpr Time kMemory = std::chrono::seconds(2);
  if (!odometry_.empty() && odometry.stamp <= odometry_.back().stamp) return;
  odometry_.push_back({odometry.stamp, odometry.T_odom_body});
  while (odometry_.front().stamp < odometry.stamp - kMemory) odometry_.pop_front();
}

void SnapshotBuilder::add(const PoseEstimate& estimate) {
  snapshot_.T_map_body = estimate.T_map_body;
  const Pose2 T_world_estimate = snapshot_.T_world_map * estimate.T_map_body;
  extend(snapshot_.estimated_path, on_ground(T_world_estimate.position()));
  if (const std::optional<Pose3> truth = pose_at(truth_, estimate.stamp)) {
    snapshot_.T_true_estimate = to_pose2(*truth).inverse() * T_world_estimate;
  }
  if (scan_) transform_scan(estimate);
}

void SnapshotBuilder::add(const Path& plan) {
  snapshot_.planned_path.clear();
  for (const Pose2& T_map_body : plan.T_map_body) {
    extend(snapshot_.planned_path, on_ground(snapshot_.T_world_map * T_map_body.position()));
  }
}

void SnapshotBuilder::add(const Event& event) {
  snapshot_.event = event.text;
  snapshot_.is_alarm = class_of(event.kind) == EventClass::kHazard && level_of(event.kind) == WarningLevel::kAlarm;
}

void SnapshotBuilder::add(const GroundTruth& truth) {
  if (!truth_.empty()) {
    if (truth.stamp <= truth_.back().stamp) return;
    const double step_m = (truth.T_world_body.position - truth_.back().pose.position).head<2>().norm();
    if (step_m < kMinKidnapStep_m) snapshot_.traveled_m += step_m;
  }
  truth_.push_back({truth.stamp, truth.T_world_body});
  snapshot_.T_world_body = truth.T_world_body;
  extend(snapshot_.true_path, on_ground(truth.T_world_body.position.head<2>()));
}

void SnapshotBuilder::add(const LiningResult& result) {
  const double height_m = snapshot_.T_world_body.position.z();
  const Pose3 T_world_map = to_pose3(snapshot_.T_world_map, height_m);
  const Eigen::Vector3d eye_m = (T_world_map * to_pose3(result.T_map_body) * T_body_lidar_).position;
  for (const RingFinding& finding : result.findings) {
    const Eigen::Vector3d p_world_m = T_world_map * finding.p_map;
    snapshot_.lining_marks.push_back({.outline = outline_on_scenery(eye_m, p_world_m),
                                      .p_world_m = p_world_m,
                                      .text = fmt::format("ring {}: {:+.1f} mm", finding.ring, 1e3 * finding.inward_m),
                                      .is_alarm = finding.level == WarningLevel::kAlarm});
  }
}

// Circle about the line of sight from the robot to the point, projected to the surfaces that the robot sees there.
std::vector<Eigen::Vector3d> SnapshotBuilder::outline_on_scenery(const Eigen::Vector3d& eye_m,
                                                                 const Eigen::Vector3d& p_world_m) const {
  constexpr int kNumPoints = 32;
  constexpr double kInFront_m = 0.02, kReach = 1.5;
  const Eigen::Vector3d line_of_sight = p_world_m - eye_m;
  const Eigen::Vector3d right = line_of_sight.cross(Eigen::Vector3d::UnitZ()).stableNormalized();
  const Eigen::Vector3d up = right.cross(line_of_sight).stableNormalized();
  std::vector<Eigen::Vector3d> outline;
  for (int i = 0; i <= kNumPoints; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kNumPoints;
    const Eigen::Vector3d direction =
        (line_of_sight + kLiningMarkRadius_m * (std::cos(angle) * right + std::sin(angle) * up)).normalized();
    const auto hit = scenery_.cast(eye_m, direction, kReach * line_of_sight.norm(), sim::kRayScenery);
    if (hit) outline.push_back(eye_m + (hit->distance_m - kInFront_m) * direction);
  }
  return outline;
}

double SnapshotBuilder::free_distance_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& direction,
                                        double max_m) const {
  const auto hit = scenery_.cast(from_m, direction, max_m, sim::kRayScenery);
  return hit ? hit->distance_m : max_m;
}

Eigen::Vector3d SnapshotBuilder::on_ground(const Eigen::Vector2d& p_world_m) const {
  // start above the robot, on ground that the robot may climb later
  constexpr double kOverBody_m = 0.5, kReach_m = 3.0;
  const double eye_z_m = snapshot_.T_world_body.position.z() + kOverBody_m;
  const Eigen::Vector3d eye(p_world_m.x(), p_world_m.y(), eye_z_m);
  const auto ground = scenery_.cast(eye, -Eigen::Vector3d::UnitZ(), kReach_m, sim::kRayScenery);
  return {p_world_m.x(), p_world_m.y(), kAboveGround_m + (ground ? eye_z_m - ground->distance_m : 0.0)};
}

// Transforms each beam by the pose of its own time: the estimate gives the planar pose at one stamp, odometry the
// motion and tilt around it.
void SnapshotBuilder::transform_scan(const PoseEstimate& estimate) {
  const Trajectory odometry(odometry_.begin(), odometry_.end());
  const Pose3 T_world_estimate =
      to_pose3(snapshot_.T_world_map * estimate.T_map_body, snapshot_.T_world_body.position.z());
  const std::optional<Pose3> T_odom_estimate = pose_at(odometry, estimate.stamp);
  Pose3 T_world_odom;  // gravity-aligned; odometry's height replaced by the true one
  if (T_odom_estimate) {
    T_world_odom = T_world_estimate * to_pose3(to_pose2(*T_odom_estimate), T_odom_estimate->position.z()).inverse();
  }
  snapshot_.scan.clear();
  const LaserScan& scan = *scan_;
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    const double range = scan.ranges_m[beam];
    if (!std::isfinite(range)) continue;
    const auto index = static_cast<double>(beam);
    const std::optional<Pose3> T_odom_body =
        T_odom_estimate ? pose_at(odometry, scan.stamp + from_seconds(index * scan.time_increment_s)) : std::nullopt;
    const Pose3 T_world_body = T_odom_body ? T_world_odom * *T_odom_body : T_world_estimate;
    const double angle = scan.angle_min_rad + index * scan.angle_increment_rad;
    snapshot_.scan.push_back(T_world_body *
                             (T_body_lidar_ * Eigen::Vector3d(range * std::cos(angle), range * std::sin(angle), 0.0)));
  }
}

}  // namespace patrol::render
